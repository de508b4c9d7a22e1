# Writes manual pages and completion of the command ALPENGLOW to the folder OUTPUT, each where it lies
# below a prefix's share folder. Run by the build.
file(REMOVE_RECURSE ${OUTPUT}) # pages of commands that are no more

function(print path)
    execute_process(COMMAND ${ALPENGLOW} ${ARGN} OUTPUT_VARIABLE text RESULT_VARIABLE status)
    if(NOT status EQUAL 0 OR text STREQUAL "")
        message(FATAL_ERROR "${ALPENGLOW} ${ARGN}: exit status ${status}")
    endif()
    file(WRITE ${OUTPUT}/${path} "${text}")
endfunction()

execute_process(COMMAND ${ALPENGLOW} --commands OUTPUT_VARIABLE names COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" names "${names}")
print(man/man1/alpenglow.1 --man)
foreach(name ${names})
    print(man/man1/alpenglow-${name}.1 --man ${name})
endforeach()
print(bash-completion/completions/alpenglow --completion bash)
print(zsh/site-functions/_alpenglow --completion zsh)
print(fish/vendor_completions.d/alpenglow.fish --completion fish)
file(TOUCH ${OUTPUT}/done)
