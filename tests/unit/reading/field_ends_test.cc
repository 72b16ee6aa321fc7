// Blocks and faults of a field with ends of their own: what a document may say of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulator/initial_state/fault_pressure.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/field_extents.h"
#include "tests/unit/scene/rotliegend.h"

namespace faultsim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Changes = std::vector<std::pair<std::string, std::string>>;

std::vector<Problem> problems_with(const Changes& changes) {
  JsonDocument document = rotliegend();
  for (const auto& [pointer, text] : changes) set_value(document, pointer, text);
  std::vector<Problem> problems;
  read_scene(document, problems);
  return problems;
}

std::array<double, 2> ends_of(const Scene& scene, std::size_t block) {
  const StrikeInterval ends = block_ends(scene.field, scene.field.blocks[block]);
  return {ends.from, ends.to};
}

TEST(FieldEnds, OfABlockAreItsOwn) {
  const Scene scene = varied(rotliegend(), {{"/geometry/blocks/0/y_from", "-500 m"},
                                            {"/geometry/blocks/0/y_to", "1.2 km"},
                                            {"/geometry/blocks/1/length", "1500 m"}});
  EXPECT_THAT(ends_of(scene, 0), ElementsAre(-500, 1200));
  EXPECT_THAT(ends_of(scene, 1), ElementsAre(-750, 750));
  const Scene one = varied(rotliegend(), {{"/geometry/blocks/0/y_to", "300 m"}});
  EXPECT_THAT(ends_of(one, 0), ElementsAre(-1000, 300)) << "the other end is that of block_length";
  EXPECT_THAT(ends_of(one, 1), ElementsAre(-1000, 1000));
}

TEST(FieldEnds, OfAFaultAreItsOwn) {
  const Scene scene = varied(rotliegend(), {{"/faults/0/y_from", "-800 m"},
                                            {"/faults/1/length", "3 km"},
                                            {"/faults/2/overshoot", "300 m"}});
  const auto along = [&](std::size_t fault) {
    const StrikeInterval ends = fault_ends(scene.field, fault);
    return std::array{ends.from, ends.to};
  };
  EXPECT_THAT(along(0), ElementsAre(-800, 1200));
  EXPECT_THAT(along(1), ElementsAre(-1500, 1500));
  EXPECT_THAT(along(2), ElementsAre(-1200, 1200));
  EXPECT_THAT(table_extent(scene, 0).strike, ElementsAre(-800, 1200)) << "of tables of pressure";
  EXPECT_EQ(fault_range(scene.field, 1).top, 2000 - 150);
  EXPECT_EQ(fault_range(scene.field, 2).top, 2000 - 300);
  EXPECT_EQ(fault_range(scene.field, 2).bottom, 2200 + 300);
}

TEST(FieldEnds, OfFaultsArePartOfTheCase) {
  const auto with = [](const Changes& changes) {
    return case_identity(varied(rotliegend(), changes));
  };
  const std::string plain = with({});
  EXPECT_EQ(with({{"/faults/0/length", "2400 m"}, {"/faults/1/overshoot", "150 m"}}), plain);
  const std::string longer = with({{"/faults/1/length", "3 km"}});
  EXPECT_NE(longer, plain);
  EXPECT_EQ(with({{"/faults/1/y_from", "-1500 m"}, {"/faults/1/y_to", "1500 m"}}), longer);
  EXPECT_NE(with({{"/faults/0/length", "3 km"}}), longer);
  EXPECT_NE(with({{"/faults/1/y_to", "1500 m"}}), longer);
  EXPECT_NE(with({{"/faults/1/overshoot", "200 m"}}), plain);
  Changes all;
  for (const char* fault : {"0", "1", "2"})
    all.emplace_back(std::string("/faults/") + fault + "/length", "3 km");
  const std::string own = with(all);
  all.emplace_back("/geometry/fault_length", "4 km");
  EXPECT_EQ(with(all), own) << "no fault is as long as that";
}

TEST(FieldEnds, OfFaultsAreRefusedWithPlaceAndCure) {
  const auto pointer = [](const Changes& changes) {
    const std::vector<Problem> problems = problems_with(changes);
    EXPECT_EQ(problems.size(), 1u) << format_problems("", problems);
    return problems.empty() ? "" : problems.front().pointer;
  };
  EXPECT_EQ(pointer({{"/faults/2/length", "20.1 km"}}), "/faults/2/length");
  EXPECT_EQ(pointer({{"/faults/2/y_to", "10.1 km"}}), "/faults/2/y_to");
  EXPECT_EQ(pointer({{"/faults/2/y_from", "1200 m"}}), "/faults/2/y_from");
  EXPECT_THAT(problems_with({{"/faults/2/y_from", "1200 m"}})[0].cure,
              testing::HasSubstr("add y_to: without it that end is at half the common length"));
  EXPECT_EQ(pointer({{"/faults/2/y_from", "0 m"}, {"/faults/2/length", "1 km"}}),
            "/faults/2/length");
  EXPECT_EQ(pointer({{"/faults/2/overshoot", "2.9 km"}}), "/faults/2/overshoot")
      << "out of the model";
  EXPECT_EQ(problems_with({{"/faults/2/overshoot", "2.1 km"}})[0].cure,
            "keep it between 0 m and 5000 m: an overshoot below 2000 m, or a larger depth");
  EXPECT_THAT(
      problems_with({{"/faults/2/overshoot", "1.9 km"}, {"/geometry/blocks/0/offset", "1.9 km"}}),
      IsEmpty())
      << "F3 is not beside the west block";
  EXPECT_EQ(pointer({{"/geometry/blocks/1/offset", "2.7 km"}}), "/geometry/blocks/1/offset");
  EXPECT_EQ(pointer({{"/faults/2/width", "1 km"}}), "/faults/2/width") << "of a box";
  JsonDocument box = parse_json(starter_scene("box"), "box");
  set_value(box, "/faults/0/y_to", "100 m");
  std::vector<Problem> problems;
  read_scene(box, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].pointer, "/faults/0/y_to");
}

/// What the scene is counts, not how it says it.
TEST(FieldEnds, ThatSayWhatHoldsAnywaySayNothing) {
  const std::string plain = case_identity(varied(rotliegend()));
  EXPECT_EQ(case_identity(varied(rotliegend(), {{"/geometry/blocks/0/length", "2 km"},
                                                {"/geometry/blocks/1/y_from", "-1 km"}})),
            plain);
  const auto with = [](const Changes& changes) {
    return case_identity(varied(rotliegend(), changes));
  };
  const std::string shorter = with({{"/geometry/blocks/1/length", "1500 m"}});
  EXPECT_NE(shorter, plain);
  EXPECT_EQ(with({{"/geometry/blocks/1/y_from", "-750 m"}, {"/geometry/blocks/1/y_to", "750 m"}}),
            shorter);
  EXPECT_NE(with({{"/geometry/blocks/1/y_to", "750 m"}}), shorter);
  EXPECT_NE(with({{"/geometry/blocks/0/length", "1500 m"}}), shorter);
}

TEST(FieldEnds, LeaveNothingToBlockLengthWhereAllBlocksSayTheirs) {
  const Changes all = {{"/geometry/blocks/0/length", "1500 m"},
                       {"/geometry/blocks/1/length", "1600 m"}};
  Changes other = all;
  other.emplace_back("/geometry/block_length", "1700 m");
  EXPECT_EQ(case_identity(varied(rotliegend(), all)), case_identity(varied(rotliegend(), other)));
  other.front() = {"/geometry/blocks/0/y_to", "750 m"};
  EXPECT_THAT(ends_of(varied(rotliegend(), other), 0), ElementsAre(-850, 750));
}

TEST(FieldEnds, AreRefusedWithPlaceAndCure) {
  const std::string block = "/geometry/blocks/0/";
  const auto one = [&](const Changes& changes) {
    const std::vector<Problem> problems = problems_with(changes);
    EXPECT_EQ(problems.size(), 1u) << format_problems("", problems);
    return problems.empty() ? Problem{} : problems.front();
  };
  const Problem both = one({{block + "length", "1 km"}, {block + "y_to", "400 m"}});
  EXPECT_EQ(both.pointer, block + "length");
  EXPECT_THAT(both.what, HasSubstr("is given alongside y_to"));
  const Problem none = one({{block + "y_from", "500 m"}, {block + "y_to", "500 m"}});
  EXPECT_EQ(none.pointer, block + "y_to");
  EXPECT_THAT(none.what, HasSubstr("block \"west\" reaches from y = 500 m to 500 m"));
  EXPECT_EQ(one({{block + "y_from", "1 km"}}).pointer, block + "y_from");
  const Problem outside = one({{block + "y_to", "10.1 km"}});
  EXPECT_EQ(outside.pointer, block + "y_to");
  EXPECT_THAT(outside.what, HasSubstr("10.1 km is not inside the model, y = -10000 m to 10000 m"));
  EXPECT_EQ(one({{block + "y_from", "-10.1 km"}}).pointer, block + "y_from");
  EXPECT_EQ(one({{block + "length", "20.1 km"}}).pointer, block + "length");
  EXPECT_THAT(problems_with({{block + "length", "20 km"}}), IsEmpty());
  EXPECT_EQ(one({{block + "length", "1 bar"}}).pointer, block + "length");
}

/// By the rule min a fault between two blocks has what both have above hydrostatic, and falls as
/// they do; beside one block alone it has nothing of it, and falls below zero.
TEST(FieldEnds, PressuresOfAFaultAreHeldAgainstBlocksPieceByPiece) {
  Changes changes;
  for (const char* block : {"0", "1"})
    changes.emplace_back(std::string("/geometry/blocks/") + block + "/overpressure", "100 bar");
  for (const char* block : {"west", "east"})
    changes.emplace_back(std::string("/compartments/") + block + "/scale", "1.45");
  changes.emplace_back("/faults/1/fault_pressure/rule", "min");
  EXPECT_THAT(problems_with(changes), IsEmpty()) << "beside both blocks alike";
  changes.emplace_back("/geometry/blocks/1/y_to", "0 m");
  const std::vector<Problem> problems = problems_with(changes);
  ASSERT_EQ(problems.size(), 1u) << format_problems("", problems);
  EXPECT_THAT(problems[0].what, HasSubstr("in fault \"F2\""));
  changes.emplace_back("/numerics/plane_strain", "on");
  EXPECT_THAT(problems_with(changes), IsEmpty()) << "no ends in plane strain";
}

/// Those of a block or fault at a pointer.
std::vector<std::string> end_keys(const JsonDocument& document, const std::string& block) {
  std::vector<std::string> found;
  for (const ParameterInfo& row : parameters(document)) {
    const std::string key = row.pointer.starts_with(block) ? row.pointer.substr(block.size()) : "";
    if (key == "length" || key == "y_from" || key == "y_to" || key == "overshoot") {
      EXPECT_TRUE(row.new_family);
      found.push_back(key);
    }
  }
  return found;
}

TEST(FieldEnds, AreParametersThatMakeNewFamilies) {
  JsonDocument document = rotliegend();
  const auto keys = [&] { return end_keys(document, "/geometry/blocks/1/"); };
  EXPECT_THAT(end_keys(document, "/faults/1/"),
              testing::UnorderedElementsAre("length", "y_from", "y_to", "overshoot"));
  EXPECT_THAT(keys(), testing::UnorderedElementsAre("length", "y_from", "y_to"));
  set_value(document, "/geometry/blocks/1/length", "1500 m");
  EXPECT_THAT(keys(), ElementsAre("length"));
  document = rotliegend();
  set_value(document, "/geometry/blocks/1/y_to", "500 m");
  EXPECT_THAT(keys(), testing::UnorderedElementsAre("y_from", "y_to"));
}

}  // namespace
}  // namespace faultsim
