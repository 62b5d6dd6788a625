# Helpers of the tests beside this file.

file(MAKE_DIRECTORY ${FOLDER})
set(tiny --size=32 --picture=48x32 --elements=1000 --benchmark_min_time=0.001)

# Writes the golden row of spheres:2000 to a file. Sets `skipped`, after saying why, where there is no device.
macro(write_golden file)
    execute_process(COMMAND ${GOLDEN_ROW} OUTPUT_FILE ${file} ERROR_VARIABLE error RESULT_VARIABLE result)
    set(skipped OFF)
    if(error MATCHES "SKIPPED")
        message(STATUS "${error}")
        set(skipped ON)
    elseif(NOT result EQUAL 0)
        message(FATAL_ERROR "${GOLDEN_ROW} failed: ${result}\n${error}")
    endif()
endmacro()

# Runs PROGRAM with arguments, expects an exit code, and sets output and error.
function(run expected)
    execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE error RESULT_VARIABLE result)
    if(NOT result EQUAL expected)
        message(FATAL_ERROR "expected exit code ${expected}, got ${result} of ${PROGRAM} ${ARGN}\n${output}${error}")
    endif()
    set(output "${output}" PARENT_SCOPE)
    set(error "${error}" PARENT_SCOPE)
endfunction()

# Fails unless the text matches the expression.
function(expect_match what text expression)
    if(NOT text MATCHES "${expression}")
        message(FATAL_ERROR "${what} does not match '${expression}':\n${text}")
    endif()
endfunction()
