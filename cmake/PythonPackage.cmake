# The Python package: pure Python, installed with the metadata by which xarray finds engine="jostle".
set(JOSTLE_PYTHON_DIR lib/python3/dist-packages
    CACHE STRING "Where the Python package goes, below the prefix")
file(GLOB of_other_versions ${PROJECT_BINARY_DIR}/python/*.dist-info)
if(of_other_versions)
  file(REMOVE_RECURSE ${of_other_versions})
endif()
set(metadata ${PROJECT_BINARY_DIR}/python/jostle-${PROJECT_VERSION}.dist-info)
file(WRITE ${metadata}/METADATA "Metadata-Version: 2.1\nName: jostle\nVersion: ${PROJECT_VERSION}\n"
                                "Summary: ${PROJECT_DESCRIPTION}\nAuthor: ${JOSTLE_AUTHORS}\n")
file(WRITE ${metadata}/entry_points.txt
     "[xarray.backends]\njostle = jostle.xarray_engine:JostleBackendEntrypoint\n")
install(DIRECTORY python/jostle ${metadata} DESTINATION ${JOSTLE_PYTHON_DIR}
        COMPONENT python PATTERN __pycache__ EXCLUDE)
# The program looks for the package beside itself, as where it is installed: jostle report --figures.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/lib/python3/dist-packages)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/python/jostle
     ${PROJECT_BINARY_DIR}/lib/python3/dist-packages/jostle SYMBOLIC)
