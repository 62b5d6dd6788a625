// SPDX-License-Identifier: MIT
/// Is there nothing where walks leap? The clearance that each block of a grid has, against one that is looked for block by block.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/scenes.hpp"
#include "support/shapes.hpp"

namespace {

/// The blocks of a grid on the host: four words each, the cells' bits in the first two and the clearance in the last.
class Blocks {
  public:
    Blocks(setka::Queue& queue, const setka::Grid& grid) : words_(queue.download(grid.compact_tables().blocks)) {
        for (int axis = 0; axis < 3; ++axis) dims_[axis] = (static_cast<int>(grid.header().dims[axis]) + 3) / 4;
    }

    [[nodiscard]] const std::array<int, 3>& dims() const { return dims_; }
    [[nodiscard]] std::uint32_t clearance(int x, int y, int z) const { return word(x, y, z, 3); }
    [[nodiscard]] bool is_empty(int x, int y, int z) const {
        const auto outside = [](int at, int dim) { return at < 0 || at >= dim; };
        return outside(x, dims_[0]) || outside(y, dims_[1]) || outside(z, dims_[2]) ||
               (word(x, y, z, 0) | word(x, y, z, 1)) == 0;
    }
    /// 4 k - 1 for the largest k up to 4 with nothing less than k blocks away.
    [[nodiscard]] std::uint32_t expected_clearance(int x, int y, int z) const {
        int k = 0;
        while (k < 4 && is_empty_around(x, y, z, k)) ++k;
        return k == 0 ? 0 : static_cast<std::uint32_t>(4 * k - 1);
    }

  private:
    [[nodiscard]] bool is_empty_around(int x, int y, int z, int distance) const {
        for (int dz = -distance; dz <= distance; ++dz)
            for (int dy = -distance; dy <= distance; ++dy)
                for (int dx = -distance; dx <= distance; ++dx)
                    if (!is_empty(x + dx, y + dy, z + dz)) return false;
        return true;
    }
    [[nodiscard]] std::uint32_t word(int x, int y, int z, int index) const {
        return words_[4 * ((std::size_t(z) * dims_[1] + y) * dims_[0] + x) + index];
    }

    std::vector<std::uint32_t> words_;
    std::array<int, 3> dims_{};
};

support::Corners small(float x, float y, float z) {
    return {setka::Float3{x, y, z}, setka::Float3{x + 0.1f, y, z}, setka::Float3{x, y + 0.1f, z + 0.1f}};
}

struct Case {
    const char* name;
    setka::Scene (*make)();
    float density;
};

/// Wide, high and deep grids, of one block a row to several words of marks, dense and almost empty.
const std::vector<Case>& cases() {
    static const std::vector<Case> all{
        {"cube", [] { return setka::make_scene("cube", 0); }, 4},
        {"terrain", [] { return setka::make_scene("terrain", 20000); }, 8},
        {"spheres", [] { return setka::make_scene("spheres", 4000); }, 8},
        {"spheres_fine", [] { return setka::make_scene("spheres", 2000); }, 100},
        {"far_apart",
         [] {
             return support::from_triangles({small(0, 0, 0), small(50, 20, 30), small(97, 3, 11)});
         },
         100000},
        {"along_x",
         [] {
             std::vector<support::Corners> row;
             for (int i = 0; i < 40; ++i) row.push_back(small(float(i * i), float(i % 5), float(i % 3)));
             return support::from_triangles(row);
         },
         1000},
    };
    return all;
}

std::vector<std::string> case_names() {
    std::vector<std::string> names;
    for (const Case& one : cases()) names.emplace_back(one.name);
    return names;
}

class Clearance : public support::DeviceAndTest<std::string> {};
SETKA_ON_EVERY_DEVICE_AND(Clearance, case_names());

TEST_P(Clearance, IsThatOfEveryBlock) {
    const Case& one = *std::ranges::find(cases(), other(), &Case::name);
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene scene(queue, one.make());
    for (const auto tables : {setka::CellTables::Bins, setka::CellTables::Scatter, setka::CellTables::RunBoundaries}) {
        const auto builder = setka::make_grid_builder({.density = one.density, .cell_tables = tables});
        const setka::Grid grid = builder->build(queue, scene);
        const Blocks blocks(queue, grid);
        std::array<int, 17> seen{};
        for (int z = 0; z < blocks.dims()[2]; ++z)
            for (int y = 0; y < blocks.dims()[1]; ++y)
                for (int x = 0; x < blocks.dims()[0]; ++x) {
                    const std::uint32_t actual = blocks.clearance(x, y, z);
                    ASSERT_EQ(actual, blocks.expected_clearance(x, y, z))
                        << "block (" << x << ", " << y << ", " << z << ") of " << blocks.dims()[0] << " x "
                        << blocks.dims()[1] << " x " << blocks.dims()[2];
                    ++seen[actual];
                }
        EXPECT_GT(seen[0], 0);
        if (other() == "far_apart" || other() == "along_x") {
            EXPECT_GT(blocks.dims()[0], 32) << "several words of marks";
            for (const int clearance : {3, 7, 11, 15}) EXPECT_GT(seen[clearance], 0);
        }
    }
}

}  // namespace
