// The sheet of a fault as a page, and as paper.
#include "campaign/figures/fault_sheet_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign/figures/pdf_file.h"
#include "tests/unit/answers/sheet_fixture.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsweep {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::SheetFixture;

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

class FaultSheetPage : public ::testing::Test {
 protected:
  void SetUp() override { f_.add_five(); }
  std::vector<FaultSheet> sheets(const SheetRequest& request = {}) {
    f_.submit_as("grid");
    return find_fault_sheets(*f_.store_, f_.campaign_, request);
  }
  /// As many stages, levels and words as a table may have.
  static std::vector<FaultSheet> long_ones(std::vector<FaultSheet> all) {
    for (FaultSheet& sheet : all) {
      while (sheet.stages.size() < 9) {
        sheet.stages.insert(sheet.stages.begin(), sheet.stages.front());
        sheet.stages.front().stage = "a_further_stage_of_cushion_gas_injection";
      }
      while (sheet.bands.size() < 8) sheet.bands.push_back(sheet.bands.front());
      while (sheet.levels.size() < 6) sheet.levels.push_back(sheet.levels.back());
      for (LevelShare& one : sheet.levels) {
        one.level.name = "twenty letters of it";
        one.level.words.assign(118, 'w');
        for (std::size_t k = 9; k < one.level.words.size(); k += 10) one.level.words[k] = ' ';
        one.level.condition = "chi_bar > 0.8 in gas_storage and not slides in gas_storage";
      }
    }
    return all;
  }
  SheetFixture f_{"</script><b onload=\"x()\">&'"};
};

TEST_F(FaultSheetPage, HasASheetForEachFaultAndRunsNothingOfANames) {
  const std::string page = sheet_page(sheets());
  EXPECT_EQ(count_of(page, "<article class=\"sheet"), 2U);
  EXPECT_EQ(count_of(page, "</article>"), 2U);
  EXPECT_EQ(count_of(page, "<script>"), 1U);
  EXPECT_EQ(count_of(page, "Content-Security-Policy"), 1U);
  EXPECT_THAT(page, Not(HasSubstr("<b onload")));
  EXPECT_THAT(page, Not(HasSubstr("somebody")));
  EXPECT_THAT(page, HasSubstr("@page"));
  for (std::size_t at = page.find("<svg"); at != std::string::npos;
       at = page.find("<svg", at + 1)) {
    const std::size_t end = page.find("</svg>", at) + 6;
    EXPECT_EQ(faultsim::figure::xml_problem(page.substr(at, end - at)), "");
  }
  EXPECT_EQ(count_of(page, "<svg"), 16U) << "place and band of each, swatch and bar of each level";
}

TEST_F(FaultSheetPage, SaysWhatTheScreenSays) {
  const std::vector<FaultSheet> all = sheets({.fault = "F2"});
  const std::string page = sheet_page(all);
  for (const char* text :
       {"no case slides down to 131 bar; by 81 bar", "231", "2 of 4 cases", "not resolved"})
    EXPECT_THAT(page, HasSubstr(text));
  for (const LevelShare& one : all[0].levels) {
    EXPECT_THAT(page, HasSubstr(one.level.name));
    EXPECT_THAT(page, HasSubstr(one.level.words));
  }
  EXPECT_EQ(page, sheet_page(find_fault_sheets(*f_.store_, f_.campaign_, {.fault = "F2"})))
      << "same input, same bits";
}

TEST_F(FaultSheetPage, IsOnePageOfPaperForEachFault) {
  const std::vector<FaultSheet> all = sheets();
  const auto pdf = pdf_of_page(sheet_page(all));
  if (!pdf) GTEST_SKIP() << "no Chromium here";
  EXPECT_EQ(count_pages(*pdf), all.size());
  EXPECT_EQ(pdf->find("(D:20"), std::string::npos) << "no date of its making";
  EXPECT_EQ(count_pages(pdf_of_page(sheet_page(long_ones(all))).value()), all.size())
      << "with as much on it as there may be";
}

TEST(PdfFile, PagesAreCountedWithoutTheirTree) {
  EXPECT_EQ(count_pages("<< /Type /Pages /Count 2 >> << /Type /Page\n>> << /Type /Page /Parent"),
            2U);
  EXPECT_EQ(count_pages(""), 0U);
}

}  // namespace
}  // namespace faultsweep
