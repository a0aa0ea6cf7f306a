# Python: MONTELUX_PYTHON=ON builds the module for the present interpreter, which must have nanobind and
# NumPy; AUTO first makes a virtual environment in the build folder, and omits the module if that fails.
set(MONTELUX_PYTHON_LEFT_OUT)
if(MONTELUX_PYTHON AND NOT MONTELUX_RENDER)
    set(MONTELUX_PYTHON_LEFT_OUT "it needs the renderer")
elseif(MONTELUX_PYTHON STREQUAL "AUTO")
    set(environment ${PROJECT_BINARY_DIR}/python-environment)
    execute_process(COMMAND ${PROJECT_SOURCE_DIR}/cmake/python-environment.sh ${environment}
        RESULT_VARIABLE failed ERROR_VARIABLE reason ERROR_STRIP_TRAILING_WHITESPACE)
    if(failed)
        set(MONTELUX_PYTHON_LEFT_OUT "${reason}")
    else()
        set(Python_EXECUTABLE ${environment}/bin/python)
    endif()
endif()
if(MONTELUX_PYTHON_LEFT_OUT)
    message(STATUS "The Python module is left out: ${MONTELUX_PYTHON_LEFT_OUT}")
endif()

if(MONTELUX_PYTHON AND NOT MONTELUX_PYTHON_LEFT_OUT)
    add_subdirectory(python)
endif()

if(MONTELUX_PYTHON AND MONTELUX_TESTS)
    if(MONTELUX_PYTHON_LEFT_OUT)
        add_test(NAME python/tests COMMAND sh -c
            "echo 'The Python module is left out: ${MONTELUX_PYTHON_LEFT_OUT}'; exit 77")
    else()
        add_test(NAME python/tests COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${PROJECT_BINARY_DIR}/python
            PYTHONDONTWRITEBYTECODE=1 MONTELUX_PROGRAM=${PROJECT_BINARY_DIR}/montelux
            ${Python_EXECUTABLE} -m pytest -q -p no:cacheprovider ${PROJECT_SOURCE_DIR}/python/tests)
        add_test(NAME python/package COMMAND ${PROJECT_SOURCE_DIR}/python/tests/package_test.sh
            ${PROJECT_BINARY_DIR}/python-package)
        set_tests_properties(python/package PROPERTIES LABELS slow TIMEOUT 3600 SKIP_RETURN_CODE 77)
        add_test(NAME python/lab COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${PROJECT_BINARY_DIR}/python
            PYTHONDONTWRITEBYTECODE=1 MONTELUX_SLOW=1
            ${Python_EXECUTABLE} -m pytest -q -p no:cacheprovider ${PROJECT_SOURCE_DIR}/python/tests/lab)
        set_tests_properties(python/lab PROPERTIES LABELS slow TIMEOUT 1200)
    endif()
    set_tests_properties(python/tests PROPERTIES LABELS fast TIMEOUT 300 SKIP_RETURN_CODE 77)
endif()
