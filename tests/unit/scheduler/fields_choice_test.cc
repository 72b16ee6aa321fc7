#include "campaign/scheduler/fields_choice.h"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/unit/store/store_fixture.h"

namespace faultsweep {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Four decided cases: families a (predicted 2.5 s), b, c and d of one case each.
class FieldsChoiceTest : public StoreTest {
 protected:
  void SetUp() override {
    StoreTest::SetUp();
    store_ = std::make_unique<Store>(Store::open_owner(folder_));
    Submission s = submission(4);
    s.keep_fields = KeepFields::shown;
    constexpr double kLong = 100;  // s, longer than what is not asked for may take
    s.families = {{"a", 1, 1, 2.5, 1}, {"b", 1, 1, kLong, 1}, {"c", 1, 1, 1, 1}, {"d", 1, 1, 1, 1}};
    s.families[3].n_operators = 3;
    s.families[3].operator_seconds = kLong;
    for (int k = 0; k < 4; ++k) s.cases[static_cast<std::size_t>(k)].family = k;
    const std::int64_t id = store_->submit(s).campaign;
    ids_ = waiting(*store_, id);
    for (const std::int64_t one : ids_) store_->record_runs(id, {completed(one, 0.7)});
    campaign_ = store_->campaign("");
  }
  void TearDown() override {
    store_.reset();
    StoreTest::TearDown();
  }
  FieldsChoice chosen() const { return choose_fields(*store_, campaign_, ids_); }
  /// An operator of the family, built in so many seconds; on file or not.
  void build(int family, double seconds, bool on_file) {
    const std::string print = "print-" + std::to_string(family);
    store_->record_operator(family + 1, {print, false, seconds, 1, 1, 1, 1});
    std::filesystem::create_directories(folder_ / "operators");
    if (on_file) std::ofstream(folder_ / "operators" / (print + ".h5")) << "x";
  }

  std::unique_ptr<Store> store_;
  CampaignInfo campaign_;
  std::vector<std::int64_t> ids_;
};

TEST_F(FieldsChoiceTest, LeavesOutWhatWouldTakeLongAndSaysWhy) {
  FieldsChoice choice = chosen();
  EXPECT_THAT(choice.positions, ElementsAre(1, 3)) << "in the order in which they are ranked";
  EXPECT_THAT(choice.cases, ElementsAre(ids_[0], ids_[2]));
  ASSERT_EQ(choice.left_out.size(), 2u);
  EXPECT_EQ(choice.left_out[0],
            "the fault fields of case 2, ranked among the first, are not kept: its operator is no "
            "longer on file, and building takes 1 min 40 s; \"keep_fields\": \"stages\" keeps "
            "those of all cases");
  EXPECT_THAT(choice.left_out[1], HasSubstr("of creeping salt are not on file, and building"));
  build(1, 100, true);
  build(3, 100, true);  // what creeping salt leaves of its operators is none of them
  choice = chosen();
  EXPECT_THAT(choice.positions, ElementsAre(1, 2, 3));
  EXPECT_EQ(choice.left_out.size(), 1u);
  build(1, 59, false);
  std::filesystem::remove_all(folder_ / "operators");
  EXPECT_THAT(chosen().positions, ElementsAre(1, 2, 3)) << "it took less than was predicted";
  build(0, 61, false);
  EXPECT_THAT(chosen().positions, ElementsAre(2, 3)) << "it took more";
}

TEST_F(FieldsChoiceTest, LeavesOutCasesWhoseRunIsLong) {
  RunRecord run = completed(ids_[0], 0.7);
  run.wall_seconds = 61;
  Connection(folder_ / "campaign.sqlite", Connection::Mode::read_write)
      .execute("UPDATE cases SET state = 'waiting'");
  store_->record_runs(campaign_.id, {run});
  const FieldsChoice choice = chosen();
  EXPECT_THAT(choice.positions, ElementsAre(3));
  EXPECT_THAT(choice.left_out.at(0), HasSubstr("of case 1, ranked among the first, are not kept: "
                                               "its run took 1 min 01 s"));
}

TEST_F(FieldsChoiceTest, LeavesAloneWhatIsThereAndWhatHasFailed) {
  store_->want_fields(campaign_.id, {ids_[0], ids_[2]});
  RunRecord kept = completed(ids_[0], 0.7), failed = crashed(ids_[2], true);
  kept.fields_only = kept.has_fields = failed.fields_only = true;
  store_->record_runs(campaign_.id, {kept, failed});
  EXPECT_THAT(chosen().cases, IsEmpty());
}

}  // namespace
}  // namespace faultsweep
