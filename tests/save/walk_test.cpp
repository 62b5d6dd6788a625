// SPDX-License-Identifier: MIT
/// Where do rays go in tables that somebody spoiled and the examination let pass? Into no place outside them.
// The translation comes before every file of the dialect.
#include "device/host_platform.h"
// The dialect.
#include "device/grid/exchange.h"
#include "device/grid/walk.h"
#include "device/grid/walk_all.h"

#include <gtest/gtest.h>

#include <cstring>
#include <iostream>
#include <vector>

#include "accel/world_geometry.hpp"
#include "save/file_maker.hpp"
#include "setka/save.hpp"
#include "setka/tracer.hpp"
#include "support/random.hpp"
#include "support/rays.hpp"

namespace {

using namespace save_test;

/// A model's tables as walks take them: blocks and cells that follow from its offsets and counts.
class WalkedTables {
  public:
    explicit WalkedTables(const Model& model) : model_(model) {
        const sk_dims dims = sk_block_dims(sk_cell_dims(model.header));
        blocks_.resize(std::size_t(dims.x) * dims.y * dims.z);
        std::vector<sk_u32> marks(std::size_t(sk_words_in_row(dims)) * dims.y * dims.z);
        references_.resize(model.references.size());
        sk_u32 totals[SK_TOTALS] = {}, cells = 0, pairs = 0;
        for (sk_u32 b = 0; b < blocks_.size(); ++b) {
            sk_import_block(b, model.header, model.counts.data(), marks.data(), blocks_.data(), totals);
            const sk_u32 of_block = blocks_[b].clearance;
            blocks_[b].first = cells;
            blocks_[b].clearance = pairs;
            cells += sk_bit_count(sk_mask_of(blocks_[b]));
            pairs += of_block;
        }
        cells_.resize(cells);
        std::vector<sk_u32> places(cells);
        for (sk_u32 b = 0; b < blocks_.size(); ++b)
            sk_import_cells(b, model.header, model.offsets.data(), model.counts.data(), marks.data(),
                            blocks_.data(), cells_.data(), places.data());
        for (sk_u32 r = 0; r < cells; ++r)
            sk_move_list(r, static_cast<sk_u32>(references_.size()), 0, cells_.data(), places.data(),
                         model.references.data(), references_.data());
    }

    [[nodiscard]] sk_grid_tables get() const {
        return sk_make_tables(blocks_.data(), cells_.data(), references_.data(),
                              model_.triangles.data(), model_.instance_starts.data(),
                              model_.instances.data());
    }

  private:
    const Model& model_;
    std::vector<sk_block> blocks_;
    std::vector<sk_cell_list> cells_;
    std::vector<sk_u32> references_;
};

sk_trace_params params_of(const Model& model, std::uint32_t mask) {
    setka::WorldGeometry geometry;
    geometry.bounds = model.bounds;
    geometry.triangle_count = model.header.triangle_count;
    geometry.instance_count = model.header.instance_count;
    return setka::trace_params(geometry, mask);
}

/// Walks every ray through the tables with the kernels' own body, on the host: under a sanitizer, a read
/// outside shows.
void walk(const Model& model, std::span<const setka::Ray> rays) {
    const WalkedTables tables(model);
    for (const std::uint32_t mask : {0x7fffffffu, 4u}) {
        const sk_trace_params params = params_of(model, mask);  // looks at every instance
        for (const setka::Ray& ray : rays)
            for (const auto step : {setka::GridStep::Dda, setka::GridStep::BranchFree}) {
                const sk_working_ray working = sk_prepare_ray(params, ray);
                sk_team team{};
                const sk_walk walk =
                    step == setka::GridStep::Dda
                        ? sk_walk_grid(&team, 0, model.header, params, working, tables.get(), SETKA_NO_HIT, 0)
                        : sk_walk_cells(model.header, params, working, tables.get(), SETKA_NO_HIT, 0);
                const SetkaHit hit = sk_make_hit(params, working, model.instance_starts.data(), walk.best);
                ASSERT_LE(walk.cost.steps,
                          model.header.dims[0] + model.header.dims[1] + model.header.dims[2]);
                ASSERT_TRUE(hit.instance == SETKA_NO_HIT || hit.instance < model.header.instance_count);
            }
    }
}

/// The same for the walk that finds all hits, which counts them and then writes as many.
void walk_all(const Model& model, std::span<const setka::Ray> rays) {
    const WalkedTables tables(model);
    const sk_trace_params params = params_of(model, 0x7fffffffu);
    const auto find = [&](const sk_working_ray& ray, SetkaHit* hits, std::uint32_t most, const int write) {
        return sk_walk_grid_all(model.header, params, ray, tables.get(), SETKA_NO_HIT, hits, most, write);
    };
    for (const setka::Ray& ray : rays) {
        const sk_working_ray working = sk_prepare_ray(params, ray);
        const std::uint32_t count = find(working, nullptr, ~0u, 0);
        std::vector<SetkaHit> hits(count);
        ASSERT_EQ(find(working, hits.data(), count, 1), count);
    }
}

/// A few random changes: of any word, or of fields that other fields follow from, with these.
void spoil_at_random(Model& model, support::Random& random) {
    const auto word = [&](auto& table) {
        auto& value = table[random.below(table.size())];
        std::uint32_t bits;
        std::memcpy(&bits, &value, 4);
        bits = random.below(2) ? static_cast<std::uint32_t>(random.bits()) : bits + random.below(3) - 1;
        std::memcpy(static_cast<void*>(&value), &bits, 4);
    };
    switch (random.below(8)) {
        case 0:
            word(model.offsets);
            break;
        case 1:
            word(model.counts);
            break;
        case 2:
            word(model.references);
            break;
        case 3:
            model.triangles[random.below(model.triangles.size())] *= random.between(0, 2);
            break;
        case 4:
            word(model.instance_starts);
            break;
        case 5:
            scale_cells(model, random.between(0.8f, 1.3f));
            break;
        case 6:
            model.references[random.below(model.references.size())] = random.below(4);
            break;
        case 7:
            model.instances[random.below(2)].mask = random.below(16);
            break;
    }
}

TEST(SpoiledTables, WhichPassKeepWalksInside) {
    const Model sound = model_of(small_scene());
    const auto rays = support::adversarial_rays(oracle::make_world(small_scene()), 300, 5);
    support::Random random(9);
    int accepted = 0;
    for (int round = 0; round < 20000; ++round) {
        Model model = sound;
        for (std::uint32_t changes = 1 + random.below(2); changes > 0; --changes)
            spoil_at_random(model, random);
        if (!setka::inspect(file_of(model)).violations.empty()) continue;
        ++accepted;
        walk(model, rays);
        walk_all(model, rays);
        if (HasFatalFailure()) FAIL() << "round " << round;
    }
    EXPECT_GT(accepted, 500);
    std::cout << accepted << " of 20000 spoiled files pass\n";
}

}  // namespace
