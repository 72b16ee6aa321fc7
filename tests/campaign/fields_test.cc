// Campaigns that keep fault fields: the real faultsweep under the real mpirun with the real
// faultsim.
#include <nlohmann/json.hpp>

#include "campaign/store/same_numbers.h"
#include "simulator/reading/read_scene.h"
#include "tests/campaign/campaign_fixture.h"
#include "tests/unit/result_files/h5_file.h"

namespace faultsweep {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A coarse box with one fault, depleted in 4 steps and filled again in 2.
json small_box() {
  json scene = json::parse(faultsim::starter_scene("box"));
  scene["mesh"] = {{"strike", "200 m"}, {"dip", "100 m"}, {"normal", "100 m"}};
  scene["stages"] = {
      {{"name", "depletion"},
       {"duration", "10 year"},
       {"steps", 4},
       {"pressure_change", "-150 bar"}},
      {{"name", "filling"}, {"duration", "2 year"}, {"steps", 2}, {"pressure_change", "-20 bar"}}};
  return scene;
}

class Fields : public testing::CampaignTest {
 protected:
  void SetUp() override {
    CampaignTest::SetUp();
    simulator_ = FAULTSIM;
    write("scene.json", small_box());
  }

  void write(const std::string& name, const json& document) const {
    std::ofstream(folder_ / name) << document.dump(1);
  }
  /// Submits friction angles of the box as a campaign; what submit printed.
  std::string submit_angles(const std::string& name, const std::vector<std::string>& angles,
                            const std::string& keep) {
    json spec = {{"format", 1}, {"name", name}, {"base", "scene.json"}};
    spec["design"] = {{"kind", "grid"}, {"parameters", {{"friction_angle", angles}}}};
    if (!keep.empty()) spec["keep_fields"] = keep;
    write(name + ".json", spec);
    const auto end = faultsweep({"submit", (folder_ / (name + ".json")).string()});
    EXPECT_EQ(end.code, 0) << end.err;
    return end.out;
  }
  json show(const std::string& name) {
    const auto end = faultsweep({"show", name, "--json"});
    EXPECT_EQ(end.code, 0) << end.err;
    return json::parse(end.out);
  }
  /// The same case by `faultsim run`; the folder of its files.
  std::filesystem::path run_alone(const std::string& angle) const {
    const std::filesystem::path out = folder_ / ("alone-" + angle.substr(0, 2));
    const std::string command = std::string(FAULTSIM) + " run " +
                                (folder_ / "scene.json").string() + " --set friction_angle='" +
                                angle + "' --cache " + (folder_ / "cache").string() + " -o " +
                                out.string() + " >/dev/null 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return out;
  }
  std::filesystem::path fields(const std::string& campaign, int position) const {
    return store_ / "fields" / campaign / std::to_string(position);
  }
};

/// Values of a step of `part` are those of the step of the same number of `whole`, bit for bit.
void expect_same_steps(const std::filesystem::path& part, const std::filesystem::path& whole) {
  const faultsim::H5File a(part / "faults.h5"), b(whole / "faults.h5");
  const std::vector<double> steps = a.read("/step").values;
  for (const char* name :
       {"traction_fault", "traction_global", "slip_fault", "slip_global", "critical_index",
        "static_critical_index", "state", "fault_pressure_change"}) {
    const std::string path = std::string("/faults/F1/steps/") + name;
    const faultsim::Dataset few = a.read(path), all = b.read(path);
    ASSERT_EQ(few.shape[0], steps.size());
    const std::size_t size = few.values.size() / steps.size();
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const auto step = static_cast<std::size_t>(steps[k]);
      EXPECT_EQ(std::memcmp(&few.values[k * size], &all.values[step * size], 8 * size), 0)
          << path << ", step " << step;
    }
  }
}

TEST_F(Fields, AreThoseOfFaultsimRunBitForBit) {
  const std::vector<std::string> angles = {"10 deg", "20 deg", "35 deg"};
  submit_angles("ends", angles, "stages");
  submit_angles("every", angles, "all");
  ASSERT_EQ(faultsweep({"run", "ends", "--workers", "2"}).code, 0);
  ASSERT_EQ(faultsweep({"run", "every", "--workers", "2"}).code, 0);
  double largest_slip = 0;
  for (int position = 1; position <= 3; ++position) {
    const auto alone = run_alone(angles[static_cast<std::size_t>(position - 1)]);
    for (const char* file : {"faults.h5", "faults.xmf"}) {
      EXPECT_EQ(bytes_of(fields("every", position) / file), bytes_of(alone / file)) << file;
    }
    const faultsim::H5File ends(fields("ends", position) / "faults.h5");
    EXPECT_THAT(ends.read("/step").values, ElementsAre(0, 4, 6));
    EXPECT_THAT(bytes_of(fields("ends", position) / "faults.xmf"), HasSubstr("faults.h5:/faults/"));
    expect_same_steps(fields("ends", position), alone);
    for (const double slip : ends.read("/faults/F1/steps/slip_fault").values) {
      largest_slip = std::max(largest_slip, std::abs(slip));
    }
  }
  EXPECT_GT(largest_slip, 1e-3) << "the comparison must see more than zeros";
}

TEST_F(Fields, AreAddedToStoredResultsWhichStay) {
  const std::vector<std::string> angles = {"10 deg", "20 deg"};
  submit_angles("plain", angles, "none");
  ASSERT_EQ(faultsweep({"run", "plain", "--workers", "2"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(store_ / "fields"));
  const json before = show("plain/1");
  EXPECT_TRUE(before["fields"].is_null());
  const std::string said = submit_angles("kept", {"10 deg", "20 deg", "30 deg"}, "stages");
  EXPECT_THAT(said, HasSubstr("2 cases with a result lack them and are run again just for these"));
  const auto end = faultsweep({"run", "kept", "--workers", "2"});
  ASSERT_EQ(end.code, 0) << end.err;
  const json after = show("kept/1");
  EXPECT_EQ(after["result"], before["result"]);
  EXPECT_EQ(after["fields"]["state"], "kept");
  EXPECT_EQ(after["fields"]["folder"], fields("kept", 1).string());
  ASSERT_EQ(after["runs"].size(), 2u);
  EXPECT_TRUE(after["runs"][1]["fields_only"]);
  EXPECT_EQ(show("kept/3")["runs"].size(), 1u);
  EXPECT_THAT(faultsim::H5File(fields("kept", 2) / "faults.h5").read("/step").values,
              ElementsAre(0, 4, 6));
  // Deleted files come back, the same; what is there is left alone.
  const std::string bytes = bytes_of(fields("kept", 2) / "faults.h5");
  const auto untouched = std::filesystem::last_write_time(fields("kept", 1) / "faults.h5");
  std::filesystem::remove_all(fields("kept", 2));
  EXPECT_EQ(faultsweep({"run", "kept", "--workers", "2"}).code, 0);
  EXPECT_EQ(bytes_of(fields("kept", 2) / "faults.h5"), bytes);
  EXPECT_EQ(std::filesystem::last_write_time(fields("kept", 1) / "faults.h5"), untouched);
}

/// Without a word in the spec: what a report and the page draw is there, of the cases that they
/// show first and of no others, and no number of any case is another.
TEST_F(Fields, OfTheThreeCasesRankedFirstAreKeptByDefault) {
  const std::vector<std::string> angles = {"35 deg", "10 deg", "30 deg", "20 deg", "15 deg"};
  const std::string said = submit_angles("plain", angles, "");
  EXPECT_THAT(said, HasSubstr("fault fields of the three cases ranked first are kept\n"));
  const auto end = faultsweep({"run", "plain", "--workers", "2"});
  ASSERT_EQ(end.code, 0) << end.err;
  const json ranking = json::parse(faultsweep({"rank", "plain", "--json", "--top", "3"}).out);
  std::vector<int> first;
  for (const json& row : ranking.at("cases")) first.push_back(row.at("case"));
  ASSERT_EQ(first.size(), 3u);
  EXPECT_THAT(end.err, HasSubstr(concat("the fault fields of the cases ranked first follow: ",
                                        joined(first, ", "), "\n")));
  for (int position = 1; position <= 5; ++position) {
    const json one = show("plain/" + std::to_string(position));
    const bool is_first = std::count(first.begin(), first.end(), position) > 0;
    EXPECT_EQ(std::filesystem::exists(fields("plain", position) / "faults.h5"), is_first);
    if (is_first) {
      EXPECT_EQ(one["fields"]["state"], "kept");
      EXPECT_EQ(one["fields"]["steps"], "stages");
    } else {
      EXPECT_TRUE(one["fields"].is_null());
    }
  }
  EXPECT_THAT(faultsim::H5File(fields("plain", first[0]) / "faults.h5").read("/step").values,
              ElementsAre(0, 4, 6));
  expect_same_steps(fields("plain", first[0]),
                    run_alone(angles[static_cast<std::size_t>(first[0] - 1)]));
  EXPECT_THAT(
      faultsweep({"status", "plain"}).out,
      HasSubstr("fault fields of the three cases ranked first are kept; 3 cases have them\n"));
  const auto page = folder_ / "report.html";
  ASSERT_EQ(faultsweep({"report", "plain", "-o", page.string()}).code, 0);
  const std::string shown = bytes_of(page);
  for (const int position : first) {
    const std::size_t part = shown.find(concat(">Case ", position, ":"));
    ASSERT_NE(part, std::string::npos) << "case " << position;
    EXPECT_NE(shown.find("Stress path of fault F1", part), std::string::npos);
  }
  EXPECT_THAT(shown, ::testing::Not(HasSubstr("which were not kept")));
  EXPECT_EQ(faultsweep({"plot", "fault-map", concat("plain/", first[0]), "-o",
                        (folder_ / "map.svg").string()})
                .code,
            0);
  // Nothing is left to do, and none of it changed a number.
  const auto written = std::filesystem::last_write_time(fields("plain", first[0]) / "faults.h5");
  ASSERT_EQ(faultsweep({"run", "plain", "--workers", "2"}).code, 0);
  EXPECT_EQ(std::filesystem::last_write_time(fields("plain", first[0]) / "faults.h5"), written);
  EXPECT_EQ(show(concat("plain/", first[0]))["runs"].size(), 2u);
  const auto kept_store = std::exchange(store_, folder_ / "other-store");
  submit_angles("bare", angles, "none");
  ASSERT_EQ(faultsweep({"run", "bare", "--workers", "1"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(store_ / "fields"));
  const Store kept = Store::open_reader(kept_store), bare = Store::open_reader(store_);
  for (int position = 1; position <= 5; ++position) {
    const auto result_in = [&](const Store& store) {
      return store.stored_case(store.campaign("").id, std::to_string(position)).result;
    };
    EXPECT_EQ(first_difference(result_in(kept), result_in(bare)), "") << "case " << position;
  }
  ASSERT_EQ(faultsweep({"report", "bare", "-o", page.string()}).code, 0);
  EXPECT_THAT(bytes_of(page),
              HasSubstr("which were not kept (keep_fields: stages in the spec keeps "
                        "those of all cases)"));
}

/// An extra that fails leaves all as it was, is said, and can be tried again.
TEST_F(Fields, OfCasesRankedFirstThatCannotBeWrittenFailNothing) {
  submit_angles("blocked", {"10 deg", "20 deg"}, "");
  std::filesystem::create_directories(store_ / "fields");
  std::ofstream(store_ / "fields" / "blocked") << "no folder";
  const auto end = faultsweep({"run", "blocked", "--workers", "2"});
  EXPECT_EQ(end.code, 0) << end.err;
  EXPECT_THAT(end.err, HasSubstr("fields of case 1 world: cannot create the folder"));
  const json refused = show("blocked/1");
  EXPECT_EQ(refused["state"], "done");
  EXPECT_EQ(refused["fields"]["state"], "failed");
  const std::string status = faultsweep({"status", "blocked", "--wide"}).out;
  EXPECT_THAT(status, HasSubstr("2 done (2 converged), 0 failed, 0 waiting"));
  EXPECT_THAT(status, HasSubstr("; 0 cases have them, 2 could not be written: `faultsweep retry "
                                "blocked` tries again"));
  EXPECT_THAT(status, HasSubstr("fields: cannot create the folder"));
  std::filesystem::remove(store_ / "fields" / "blocked");
  EXPECT_EQ(faultsweep({"retry", "blocked"}).out, "2\n");
  EXPECT_EQ(faultsweep({"run", "blocked", "--workers", "2"}).code, 0);
  EXPECT_EQ(show("blocked/1")["fields"]["state"], "kept");
}

TEST_F(Fields, ThatCannotBeWrittenAreRowsWithAReason) {
  submit_angles("blocked", {"10 deg", "20 deg"}, "all");
  std::filesystem::create_directories(store_ / "fields");
  std::ofstream(store_ / "fields" / "blocked") << "no folder";
  EXPECT_EQ(faultsweep({"run", "blocked", "--workers", "2"}).code, 1);
  const json refused = show("blocked/1");
  EXPECT_EQ(refused["state"], "failed");
  EXPECT_EQ(refused["runs"][0]["status"], "world");
  EXPECT_THAT(refused["runs"][0]["reason"].get<std::string>(),
              HasSubstr("cannot create the folder " + fields("blocked", 1).string()));
  std::filesystem::remove(store_ / "fields" / "blocked");

  // A disk that is full at 4 kB per file: the simulator under a limit of its shell.
  simulator_ = folder_ / "small-disk";
  std::ofstream(simulator_) << "#!/bin/sh\nulimit -f 8\nexec " << FAULTSIM << " \"$@\"\n";
  std::filesystem::permissions(simulator_, std::filesystem::perms(0755));
  EXPECT_EQ(faultsweep({"retry", "blocked"}).out, "2\n");
  EXPECT_EQ(faultsweep({"run", "blocked", "--workers", "2"}).code, 1);
  const json full = show("blocked/2");
  EXPECT_EQ(full["runs"][1]["status"], "world");
  EXPECT_THAT(full["runs"][1]["reason"].get<std::string>(), HasSubstr("faults.h5: File too large"));
  EXPECT_TRUE(std::filesystem::is_empty(fields("blocked", 2)));

  simulator_ = FAULTSIM;
  EXPECT_EQ(faultsweep({"retry", "blocked"}).out, "2\n");
  EXPECT_EQ(faultsweep({"run", "blocked", "--workers", "2"}).code, 0);
  EXPECT_EQ(show("blocked/2")["fields"]["state"], "kept");
}

/// Every file that has its name is complete, whenever simulators are killed; later runs complete
/// the campaign and clean up.
TEST_F(Fields, OfKilledCasesNeverLookComplete) {
  json scene = small_box();
  constexpr int kSteps = 60;
  scene["stages"] = {{{"name", "depletion"},
                      {"duration", "10 year"},
                      {"steps", kSteps},
                      {"pressure_change", "-150 bar"}}};
  write("scene.json", scene);
  constexpr int kCases = 120;
  std::vector<std::string> angles;
  for (int k = 0; k < kCases; ++k) angles.push_back(std::to_string(10 + 0.2 * k) + " deg");
  submit_angles("sweep", angles, "all");
  const auto expect_complete = [&] {
    int n_found = 0;
    for (int position = 1; position <= kCases; ++position) {
      const auto file = fields("sweep", position) / "faults.h5";
      if (!std::filesystem::exists(file)) continue;
      ++n_found;
      const faultsim::H5File h5(file);
      EXPECT_EQ(h5.read("/step").values.size(), kSteps + 1u) << file;
      EXPECT_EQ(h5.read("/faults/F1/steps/slip_fault").shape[0], kSteps + 1u) << file;
    }
    return n_found;
  };
  const pid_t starter = start({"run", "--workers", "2"});
  constexpr int kKills = 6;
  constexpr long kBetween = 4;  // cases done from one kill to the next: simulators are at work
  int n_kills = 0;
  for (long done = kBetween; n_kills < kKills && wait_for_done(done); done += kBetween) {
    usleep(1700 * static_cast<unsigned>(n_kills));  // at another point of a case each time
    for (const pid_t mpirun : children_of(starter)) {
      for (const pid_t rank : children_of(mpirun)) {
        for (const pid_t simulator : children_of(rank)) n_kills += kill(simulator, SIGKILL) == 0;
      }
    }
    done = std::max(done, Store::open_reader(store_).campaign("").n_done);
  }
  EXPECT_GE(n_kills, kKills);
  const auto killed = wait(starter);
  EXPECT_TRUE(killed.code == 0 || killed.code == 1) << killed.err;
  EXPECT_GE(expect_complete(), Store::open_reader(store_).campaign("").n_done);
  faultsweep({"retry"});
  const auto end = faultsweep({"run", "--workers", "2"});
  EXPECT_EQ(end.code, 0) << end.err;
  EXPECT_EQ(expect_complete(), kCases);
  for (int position = 1; position <= kCases; ++position) {
    const std::filesystem::directory_iterator entries(fields("sweep", position));
    EXPECT_EQ(std::distance(entries, {}), 2) << "case " << position;
  }
  EXPECT_THAT(Store::open_reader(store_).integrity_problems(), IsEmpty());
}

}  // namespace
}  // namespace faultsweep
