#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "campaign/expansion/expansion.h"
#include "simulator/reading/read_scene.h"

namespace faultsweep {

/// A campaign on the reference scene in plane strain; design and further keys as JSON text.
inline Expansion expand_design(const std::string& design, const std::string& more = "") {
  const std::string text =
      R"({"format": 1, "name": "test", "base": "docs/examples/scenes/rotliegend.json", )"
      R"("set": {"/tier": "screening"}, )" +
      more + R"("design": )" + design + "}";
  return expand(parse_campaign(text, FAULTSIM_SOURCE_DIR "/test.json"));
}

inline std::string values_of(const Expansion& expansion, std::size_t i) {
  std::string text;
  for (const auto& value : parameters_of(expansion, expansion.cases.at(i))) {
    text += (text.empty() ? "" : " ") + value.name + "=" + value.text;
  }
  return text;
}

/// The identity and family of a case by the long way: its scene document read and planned.
inline std::pair<std::string, std::string> the_long_way(const Expansion& expansion,
                                                        const Case& one) {
  const auto scene = faultsim::read_scene({"test", scene_of(expansion, one), {}});
  std::vector<faultsim::Problem> problems;
  return {faultsim::case_identity(scene), faultsim::make_plan(scene, problems).family};
}

/// Every stride-th case has the identity and the family that the long way gives.
inline void expect_true_identities(const Expansion& expansion, std::size_t stride) {
  for (std::size_t i = 0; i < expansion.cases.size(); i += stride) {
    const Case& one = expansion.cases[i];
    const auto [identity, family] = the_long_way(expansion, one);
    ASSERT_EQ(one.identity, identity) << values_of(expansion, i);
    ASSERT_EQ(expansion.families[static_cast<std::size_t>(one.family)].fingerprint, family)
        << values_of(expansion, i);
  }
}

}  // namespace faultsweep
