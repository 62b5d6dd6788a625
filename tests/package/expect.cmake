# SPDX-License-Identifier: MIT
# Does a command succeed and say something? Removes the folder REMOVE, if one is named, and runs COMMAND, a list; its
# exit code has to be 0, and its output has to match EXPECTED.
cmake_minimum_required(VERSION 3.22)
if(REMOVE)
    file(REMOVE_RECURSE ${REMOVE})
endif()
execute_process(COMMAND ${COMMAND} OUTPUT_VARIABLE output ERROR_VARIABLE error RESULT_VARIABLE result)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "${COMMAND} failed: ${result}\n${output}${error}")
endif()
if(NOT output MATCHES "${EXPECTED}")
    message(FATAL_ERROR "${COMMAND} does not say '${EXPECTED}':\n${output}${error}")
endif()
message(STATUS "${CMAKE_MATCH_0}")
