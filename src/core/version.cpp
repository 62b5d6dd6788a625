// SPDX-License-Identifier: MIT
#include "setka/version.hpp"

#define SETKA_TEXT_OF(x) #x
#define SETKA_TEXT(x) SETKA_TEXT_OF(x)

namespace setka {

const char* version() noexcept {
    return SETKA_TEXT(SETKA_VERSION_MAJOR) "." SETKA_TEXT(SETKA_VERSION_MINOR) "." SETKA_TEXT(SETKA_VERSION_PATCH);
}

}  // namespace setka
