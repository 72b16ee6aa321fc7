#include "simulator/corner_point/structure_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "made_grid.h"
#include "simulator/corner_point/structure_finder.h"

namespace faultsim::corner_point {
namespace {

using testing::HasSubstr;

GridStructure of_a_fault() {
  const MadeGrid grid{.size = {8, 4, 2},
                      .lean = {0.5, 0},
                      .faults = {{{400, 0}, {400, 320}, [](double) { return 30.0; }}}};
  return recognise_structure(made(grid), {.reference_z = -2000});
}

TEST(StructureText, SaysWhatWasRecognisedAndChosen) {
  const std::string text = structure_text(of_a_fault());
  EXPECT_THAT(text, HasSubstr("8 x 4 x 2 cells, 64 active, in 32 columns; 3 horizons\n"));
  EXPECT_THAT(text,
              HasSubstr("fault 1: 4 pillar edges, 320 m long, straight to 0 m with 1 piece, "
                        "largest offset 30 m, right is lower; dips 63 degrees (63 to 63) towards "
                        "90, a normal fault; ends: at the edge of the grid with an offset of 30 m; "
                        "at the edge of the grid with an offset of 30 m [least_offset]\n"));
  EXPECT_THAT(text, HasSubstr("2 compartments bounded by faults [compartments]\n"));
  EXPECT_THAT(text, HasSubstr("chosen: traces are those at z = -2000 m [reference_z]\n"));
  EXPECT_THAT(text,
              HasSubstr("    1      4       320      30.0       63           90  edge, edge\n"));
  EXPECT_THAT(text, HasSubstr("          1     32     0.125   3.84e+06     -1993.4"));
}

TEST(StructureText, HasTracesAndOffsetsAsTables) {
  const GridStructure found = of_a_fault();
  EXPECT_THAT(traces_csv(found), testing::StartsWith("fault,x [m],y [m]\n1,"));
  const std::string offsets = offsets_csv(found);
  EXPECT_EQ(std::ranges::count(offsets, '\n'), 6);
  EXPECT_THAT(offsets, testing::StartsWith("fault,along [m],x [m],y [m],offset [m]\n1,"));
}

}  // namespace
}  // namespace faultsim::corner_point
