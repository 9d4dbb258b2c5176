# SPDX-License-Identifier: Apache-2.0
# run(<command> ...): stops the test if the command fails. Its output is in run_output.
function(run)
  list(JOIN ARGN " " shown)
  message(STATUS "$ ${shown}")
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed with ${result}: ${shown}\n${output}\n${errors}")
  endif()
  set(run_output "${output}" PARENT_SCOPE)
endfunction()

# expect_press(<text>): the haptic loop has pressed something.
function(expect_press text)
  if(NOT text MATCHES "[0-9]+ ticks")
    message(FATAL_ERROR "the haptic loop did not say how it ran:\n${text}")
  endif()
  if(NOT text MATCHES " 5\\.000 +1[0-9]\\.[0-9]+")
    message(FATAL_ERROR "5 mm into the cube must give 10 to 20 N:\n${text}")
  endif()
endfunction()
