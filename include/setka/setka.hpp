// SPDX-License-Identifier: MIT
/// The whole core API in one include.
#pragma once

#include "setka/device.hpp"
#include "setka/device_scene.hpp"
#include "setka/error.hpp"
#include "setka/file_format.h"
#include "setka/grid.hpp"
#include "setka/image.hpp"
#include "setka/layout.h"
#include "setka/renderer.hpp"
#include "setka/save.hpp"
#include "setka/scene.hpp"
#include "setka/scenes.hpp"
#include "setka/structure.hpp"
#include "setka/tracer.hpp"
#include "setka/version.hpp"
