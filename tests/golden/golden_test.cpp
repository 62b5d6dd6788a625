// SPDX-License-Identifier: MIT
/// Does every device compute what an NVIDIA GPU computed? The digests of tests/golden/digests.txt, with both steps; scene files
/// come from the environment's SETKA_SCENES, or ../shared/scenes beside the project.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "golden/cases.hpp"
#include "support/devices.hpp"
#include "support/scenes.hpp"
#include "workload/named_scene.hpp"

namespace {

using namespace setka;

[[nodiscard]] const std::vector<workload::GoldenRow>& rows() {
    static const auto all = workload::read_golden(SETKA_GOLDEN_FILE);
    return all;
}

TEST(Golden, HasARowForEachCase) {
    EXPECT_EQ(rows().size(), golden::cases().size());
    for (const workload::GoldenCase& what : golden::cases())
        EXPECT_TRUE(workload::find_golden(rows(), what)) << what.to_string();
}

TEST(Golden, RowsDiffer) {
    std::set<std::string> tables;
    for (const workload::GoldenRow& row : rows()) tables.insert(row.fingerprint.tables.to_string());
    EXPECT_EQ(tables.size(), rows().size());
}

[[nodiscard]] std::vector<std::string> case_names() {
    std::vector<std::string> names;
    for (const workload::GoldenCase& what : golden::cases()) names.push_back(what.to_string());
    return names;
}

class GoldenDigests : public support::DeviceAndTest<std::string> {};
SETKA_ON_EVERY_DEVICE_AND(GoldenDigests, case_names());

TEST_P(GoldenDigests, AreComputedHere) {
    const auto at = std::ranges::find(rows(), other(), [](const auto& row) { return row.what.to_string(); });
    ASSERT_NE(at, rows().end());
    const workload::GoldenCase& what = at->what;
    const auto folder = support::scene_folder();
    const auto scene = workload::NamedScene{what.scene}.load(folder.value_or("."));
    if (!scene) GTEST_SKIP() << "there is no " << what.scene << " in the folder of scene files; set SETKA_SCENES";
    setka::Queue queue = device().make_queue();
    const GridOptions options{.density = what.density};
    for (const GridStep step : {GridStep::Dda, GridStep::BranchFree}) {
        const auto actual = workload::take_fingerprint(queue, *scene, what.viewpoint, options, step).parts();
        const auto expected = at->fingerprint.parts();
        for (std::size_t i = 0; i < actual.size(); ++i)
            EXPECT_EQ(actual[i].second.to_string(), expected[i].second.to_string())
                << actual[i].first << (step == GridStep::Dda ? ", DDA" : ", branch-free");
    }
}

}  // namespace
