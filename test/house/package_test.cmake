# Installs components of Montelux, then configures, builds and runs an outside project that finds them with
# find_package. The project is built without link-time optimisation, whatever the library was built with.
#   build, config     what is installed
#   components        of it, separated by commas
#   without           packages that the project must not need, separated by commas
#   source            the project
#   programs          programs that it builds, separated by commas; each must end with 0
#   expected          a pattern of what they print together
function(step)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output
        WORKING_DIRECTORY ${work})
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "failed (${result}): ${ARGN}\n${output}")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${work})
string(REPLACE "," ";" components "${components}")
string(REPLACE "," ";" without "${without}")
list(TRANSFORM without REPLACE ".+" "-DCMAKE_DISABLE_FIND_PACKAGE_\\0=ON")
foreach(component ${components})
    step(${CMAKE_COMMAND} --install ${build} --prefix ${work}/prefix --config ${config} --component ${component})
endforeach()
step(${CMAKE_COMMAND} -S ${source} -B ${work}/build -G Ninja -D CMAKE_PREFIX_PATH=${work}/prefix
    -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_BUILD_TYPE=Release ${without})
step(${CMAKE_COMMAND} --build ${work}/build)
string(REPLACE "," ";" programs "${programs}")
set(printed)
foreach(program ${programs})
    step(${work}/build/${program})
    string(APPEND printed "${output}")
endforeach()
message(STATUS "${printed}")
if(NOT printed MATCHES "${expected}")
    message(FATAL_ERROR "it should have printed '${expected}', but what it printed was: ${printed}")
endif()
