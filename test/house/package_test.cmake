# Installs montelux::mc, then configures, builds and runs an outside project that finds it with find_package.
# The consumer is built without link-time optimisation, whatever the library was built with.
function(step)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "failed (${result}): ${ARGN}\n${output}")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${work})
step(${CMAKE_COMMAND} --install ${build} --prefix ${work}/prefix --config ${config} --component mc)
# An installation of mc alone must not ask for Embree: the consumer's project never looks for it.
step(${CMAKE_COMMAND} -S ${source} -B ${work}/build -G Ninja -D CMAKE_PREFIX_PATH=${work}/prefix
    -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_BUILD_TYPE=Release
    -D CMAKE_DISABLE_FIND_PACKAGE_embree=ON -D CMAKE_DISABLE_FIND_PACKAGE_OpenEXR=ON)
step(${CMAKE_COMMAND} --build ${work}/build)
step(${work}/build/integral)
message(STATUS "${output}")
if(NOT output MATCHES "= (0\\.99|1\\.00)[0-9]*\\([0-9]+\\)")
    message(FATAL_ERROR "the integral of sin x over [0, pi/2] is 1; the consumer printed: ${output}")
endif()
