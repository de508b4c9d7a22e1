# Install rules, find_package and pkg-config files. All of it may be moved: no path is absolute.
set(ALP_PACKAGE_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/alpenglow)

install(TARGETS alpenglow EXPORT alpenglowTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/alpenglow DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.h")
install(FILES ${PROJECT_BINARY_DIR}/include/alpenglow/version.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/alpenglow)

# The installed command finds the library beside it, wherever the two were moved.
file(RELATIVE_PATH ALP_BIN_TO_LIB "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
set_target_properties(alpenglow_command PROPERTIES INSTALL_RPATH "$ORIGIN/${ALP_BIN_TO_LIB}")
install(TARGETS alpenglow_command DESTINATION ${CMAKE_INSTALL_BINDIR})
if(TARGET alpenglow_view)
    set_target_properties(alpenglow_view PROPERTIES INSTALL_RPATH "$ORIGIN/${ALP_BIN_TO_LIB}")
    install(TARGETS alpenglow_view DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(TARGET alpenglow_mpi)
    set_target_properties(alpenglow_mpi PROPERTIES INSTALL_RPATH "$ORIGIN/${ALP_BIN_TO_LIB}")
    install(TARGETS alpenglow_mpi DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(TARGETS alpenglow_bench DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/alpenglow)
if(TARGET alpenglow_manual)
    set(printed ${PROJECT_BINARY_DIR}/printed)
    install(DIRECTORY ${printed}/man/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
    install(DIRECTORY ${printed}/bash-completion ${printed}/zsh ${printed}/fish
            DESTINATION ${CMAKE_INSTALL_DATADIR})
endif()
# What viewers need to show maps of --atlas blend.
install(FILES web/blend.glsl web/three-blend.js
        DESTINATION ${CMAKE_INSTALL_DATADIR}/alpenglow)
# What renderers need to read probes.
install(FILES shaders/probes.glsl DESTINATION ${CMAKE_INSTALL_DATADIR}/alpenglow/shaders)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# find_package(alpenglow). A static library needs its libraries found again; a shared one does not.
get_target_property(ALP_LIBRARY_TYPE alpenglow TYPE)
configure_package_config_file(cmake/alpenglowConfig.cmake.in alpenglowConfig.cmake
                              INSTALL_DESTINATION ${ALP_PACKAGE_FOLDER})
write_basic_package_version_file(alpenglowConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT alpenglowTargets NAMESPACE alpenglow:: DESTINATION ${ALP_PACKAGE_FOLDER})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/alpenglowConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/alpenglowConfigVersion.cmake
        DESTINATION ${ALP_PACKAGE_FOLDER})

# pkg-config. Only programs with a static library link its libraries, and so need their files. Embree
# 3 and meshoptimizer have no .pc file of their own.
if(ALP_LIBRARY_TYPE STREQUAL "STATIC_LIBRARY")
    set(ALP_PKGCONFIG_REQUIRES "jansson libpng libjpeg OpenEXR libxml-2.0 zlib libzstd libwebp")
    set(ALP_PKGCONFIG_LIBS "-lembree3 -lmeshoptimizer")
    if(ALP_HAS_DRACO)
        string(APPEND ALP_PKGCONFIG_REQUIRES " draco")
        string(APPEND ALP_PKGCONFIG_LIBS " -lstdc++")
    endif()
    string(APPEND ALP_PKGCONFIG_LIBS " -lm -pthread")
endif()
set(ALP_PKGCONFIG_FOLDER ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH ALP_PKGCONFIG_TO_PREFIX "${CMAKE_INSTALL_PREFIX}/${ALP_PKGCONFIG_FOLDER}"
     "${CMAKE_INSTALL_PREFIX}")
string(REGEX REPLACE "/$" "" ALP_PKGCONFIG_TO_PREFIX "${ALP_PKGCONFIG_TO_PREFIX}")
configure_file(cmake/alpenglow.pc.in alpenglow.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/alpenglow.pc DESTINATION ${ALP_PKGCONFIG_FOLDER})
