// SPDX-License-Identifier: MIT
/// Who lost it, if the library is gone by the time the leak checker reports? Nobody unloads a library here, so
/// that drivers can be named in tests/driver_leaks.txt.
extern "C" int dlclose(void* library);
extern "C" int dlclose(void* /*library*/) { return 0; }
