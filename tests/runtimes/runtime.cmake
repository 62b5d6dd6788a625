# SPDX-License-Identifier: MIT
# How is a program started on one OpenCL driver and no other? Sets, for the scripts beside this file, from RUNTIME (pocl,
# rusticl, oclgrind, intel, pocl_wheel or all) and WORK (a folder that may be written to):
#   runtime_environment   arguments for `cmake -E env`
#   runtime_device        a regular expression that each line of `setka_digest devices` has to match
# and ends the test, with a line that ctest takes for a skip, where the driver is not installed or cannot compile for the machine;
# SETKA_REQUIRE_RUNTIMES, names separated by commas, makes that a failure.

# Ends the test: there is no such driver here, or none that works.
macro(runtime_missing why)
    string(REPLACE "," ";" runtimes_required "$ENV{SETKA_REQUIRE_RUNTIMES}")
    if(RUNTIME IN_LIST runtimes_required)
        message(FATAL_ERROR "SETKA_REQUIRE_RUNTIMES asks for ${RUNTIME}: ${why}")
    endif()
    message(STATUS "SKIPPED: ${RUNTIME}: ${why}")
    return()
endmacro()

# The drivers that these vendor files name, as an ICD loader's folder of their own.
function(runtime_use_vendor_files folder)
    foreach(file IN LISTS ARGN)
        get_filename_component(name ${file} NAME)
        file(STRINGS ${file} library LIMIT_COUNT 1)
        file(WRITE ${folder}/${name} "${library}\n")
    endforeach()
endfunction()

set(runtime_vendors ${WORK}/vendors_${RUNTIME})
file(REMOVE_RECURSE ${runtime_vendors})
file(MAKE_DIRECTORY ${runtime_vendors} ${WORK}/cache_${RUNTIME})
set(runtime_environment OCL_ICD_VENDORS=${runtime_vendors} --unset=OCL_ICD_FILENAMES --unset=SETKA_DEVICE --unset=SETKA_LOG
    --unset=SETKA_WIDTH --unset=SETKA_TEST_SIZE --unset=OCLGRIND_LOG SETKA_REQUIRE=opencl CUDA_VISIBLE_DEVICES= POCL_CACHE_DIR=${WORK}/cache_${RUNTIME})
set(runtime_missing_why "")

if(RUNTIME STREQUAL "pocl")
    set(runtime_files /etc/OpenCL/vendors/pocl.icd)
    set(runtime_device "Portable Computing Language")
elseif(RUNTIME STREQUAL "rusticl")
    set(runtime_files /etc/OpenCL/vendors/rusticl.icd)
    set(runtime_device "llvmpipe.*rusticl")
    list(APPEND runtime_environment RUSTICL_ENABLE=llvmpipe)
elseif(RUNTIME STREQUAL "all")  # what the loader finds in a process of a machine that has both
    set(runtime_files /etc/OpenCL/vendors/pocl.icd /etc/OpenCL/vendors/rusticl.icd)
    set(runtime_device "Portable Computing Language|llvmpipe.*rusticl")
    list(APPEND runtime_environment RUSTICL_ENABLE=llvmpipe)
elseif(RUNTIME STREQUAL "oclgrind")
    set(runtime_files "")
    find_library(oclgrind_library oclgrind-rt-icd PATHS /usr/lib/oclgrind /usr/local/lib NO_CACHE)
    if(oclgrind_library)
        file(WRITE ${runtime_vendors}/oclgrind.icd "${oclgrind_library}\n")
    else()
        set(runtime_missing_why "liboclgrind-rt-icd.so was not found; install oclgrind")
    endif()
    set(runtime_device "Oclgrind")
    # Without optimisation: the inliner of its compiler leaves intrinsics that Oclgrind 21.10 does not know. Without pooling: what
    # lies beyond a buffer's end is then out of bounds, and see OCLGRIND_UNINITIALIZED in digests.cmake.
    list(APPEND runtime_environment OCLGRIND_BUILD_OPTIONS=-cl-opt-disable OCLGRIND_DATA_RACES=1 OCLGRIND_CHECK_API=1
         SETKA_POOL=0)
else()
    include(${CMAKE_CURRENT_LIST_DIR}/wheels.cmake)
endif()

foreach(file IN LISTS runtime_files)
    if(EXISTS ${file})
        runtime_use_vendor_files(${runtime_vendors} ${file})
    else()
        set(runtime_missing_why "there is no ${file}; install mesa-opencl-icd (rusticl) or pocl-opencl-icd (pocl)")
    endif()
endforeach()

# Runs `command` on the driver: sets output, error and result.
macro(runtime_run)
    execute_process(COMMAND ${CMAKE_COMMAND} -E env ${runtime_environment} ${ARGN}
                    OUTPUT_VARIABLE output ERROR_VARIABLE error RESULT_VARIABLE result)
endmacro()

# Has the commands from here on use kernels of WIDTH, if that is given: a SETKA_WIDTH.
macro(runtime_use_width)
    if(WIDTH)
        list(APPEND runtime_environment SETKA_WIDTH=${WIDTH} SETKA_LOG=build,launch)
    endif()
endmacro()

# Fails unless the command's kernels were those.
macro(runtime_check_width)
    if("${WIDTH}" STREQUAL "team")
        set(asked_for "-DSK_TEAM=32")
    else()
        set(asked_for "-DSK_WIDTH=${WIDTH}u")
    endif()
    if(WIDTH AND NOT error MATCHES "${asked_for}")
        message(FATAL_ERROR "${RUNTIME} was not asked for kernels of width ${WIDTH}:\n${error}")
    endif()
endmacro()

# Ends the test if the command failed because the driver's compiler is older than this machine's processor: LLVM then calls it
# "generic", which Clang refuses for any program of anyone. (Our build options name no processor.)
macro(runtime_missing_if_processor_is_unknown)
    if(NOT result EQUAL 0 AND "${output}${error}" MATCHES "unknown target CPU '([^']*)'")
        runtime_missing("its compiler does not know this machine's processor: unknown target CPU '${CMAKE_MATCH_1}'")
    endif()
endmacro()

# Fails unless the driver's devices, and no others, are what the program sees.
function(runtime_check_devices program)
    runtime_run(${program} devices)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${RUNTIME}: listing the devices failed: ${result}\n${output}${error}")
    endif()
    string(STRIP "${output}" output)
    string(REPLACE "\n" ";" lines "${output}")
    foreach(line IN LISTS lines)
        if(NOT line MATCHES "${runtime_device}")
            message(FATAL_ERROR "${RUNTIME}: a device of another driver: ${line}")
        endif()
    endforeach()
    list(LENGTH lines count)
    if((RUNTIME STREQUAL "all" AND NOT count EQUAL 2) OR (NOT RUNTIME STREQUAL "all" AND NOT count EQUAL 1))
        message(FATAL_ERROR "${RUNTIME}: ${count} devices:\n${output}")
    endif()
    message(STATUS "${output}")
endfunction()

# Fails unless Oclgrind had nothing to say, on stderr, about the command that was run: its exit code says nothing. (Its log file
# holds no more than the last context's reports.) Lines of SETKA_LOG are not its.
function(runtime_check_oclgrind_reports)
    string(REGEX REPLACE "setka: [^\n]*\n" "" reports "${error}")
    string(STRIP "${reports}" reports)  # an empty build log leaves empty lines
    if(NOT reports STREQUAL "")
        string(SUBSTRING "${reports}" 0 4000 reports)
        message(FATAL_ERROR "Oclgrind reports:\n${reports}")
    endif()
endfunction()
