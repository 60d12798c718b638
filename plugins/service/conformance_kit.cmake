find_package(Threads REQUIRED)
pkg_check_modules(MPFR REQUIRED IMPORTED_TARGET mpfr)
set(AMBIT_PLUGIN_LIBRARIES ambit_inside PkgConfig::MPFR Threads::Threads)
