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
  # The hand goes in by 5 mm: the coupling of 400 N/m and the cube of about 2,070 N/m share them.
  if(NOT text MATCHES " 0\\.7[0-9]+ +1\\.[67][0-9]+")
    message(FATAL_ERROR "a hand 5 mm deep must feel some 1.7 N:\n${text}")
  endif()
endfunction()
