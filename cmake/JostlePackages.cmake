# cpack -G DEB: jostle (the program), libjostle-dev (its libraries) and python3-jostle, from what
# cmake --install installs. ./dev package runs it. Packages are reproducible: a commit
# and SOURCE_DATE_EPOCH determine their bytes, in any folder.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME jostle)
set(CPACK_JOSTLE_AUTHORS "${JOSTLE_AUTHORS}")
set(CPACK_JOSTLE_ADDRESS "${JOSTLE_ADDRESS}")
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/PackageContact.cmake)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_COMPONENTS_ALL jostle dev python)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
# Other content of a package: its Debian changelog, compressed pages, one time for all files.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/PackageFiles.cmake)
set(CPACK_JOSTLE_SOURCE_DIR ${PROJECT_SOURCE_DIR})

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(CPACK_DEBIAN_JOSTLE_PACKAGE_NAME jostle)
set(CPACK_DEBIAN_JOSTLE_PACKAGE_SECTION science)
set(CPACK_DEBIAN_JOSTLE_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_JOSTLE_PACKAGE_SUGGESTS "libjostle-dev, python3-jostle")
set(CPACK_COMPONENT_JOSTLE_DESCRIPTION
    "Runs many realizations of a bed of spheres that is tapped again and again, by
Monte Carlo or by discrete elements, and measures how it gets denser: compaction
curves with errors, fits of the published laws, ageing, hysteresis, and the
structure of the packings.")

# The libraries are static: a program links their dependencies itself.
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libjostle-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
string(REGEX MATCH "^[0-9]+" fmt_major ${fmt_VERSION})
math(EXPR fmt_next "${fmt_major} + 1")
string(REGEX MATCH "^[0-9]+[.][0-9]+" fmt_least ${fmt_VERSION})
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
    "libeigen3-dev, libfmt-dev (>= ${fmt_least}), libfmt-dev (<< ${fmt_next}), libhdf5-dev, libmuparser-dev, libssl-dev, libtbb-dev, nlohmann-json3-dev, voro++-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS jostle)
set(CPACK_COMPONENT_DEV_DESCRIPTION
    "Static libraries and headers of jostle, and the files by which CMake's
find_package(jostle) finds them: scenes, runs, fits and analyses from C++.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-jostle)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3-h5py, python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS
    "jostle, python3-jsonschema, python3-matplotlib, python3-pandas, python3-xarray")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
    "Reads results of jostle as numpy arrays and xarray datasets, runs the program
and draws the main figures.")
include(CPack)
