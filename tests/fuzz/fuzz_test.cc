#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "campaign/expansion/expansion.h"
#include "campaign/nightly/nightly_suite.h"
#include "simulator/plan/geometry_check.h"
#include "simulator/reading/read_scene.h"
#include "tests/fuzz/mutator.h"

// UDUNITS 2.2 does not free the name in some units that it refuses: some bytes per refusal.
extern "C" const char* __lsan_default_suppressions() { return "leak:libudunits2"; }

/// Sieves for every kind of input: whatever is thrown at them, they accept it or refuse it with
/// problems that have a text, within the time of a blink. Each target tries inputs 0, 1, 2, ... of
/// its sequence for FAULTSIM_FUZZ_SECONDS (default 5; an hour is 900 for each of four), beginning
/// at FAULTSIM_FUZZ_FIRST. An input that fails is left in the folder named by the message; make a
/// case under tests/cases/ of it.
namespace faultsim {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = FAULTSIM_SOURCE_DIR;

double from_environment(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atof(text);
}

std::vector<std::string> texts_in(const std::vector<fs::path>& folders, const std::string& end) {
  std::vector<fs::path> files;
  for (const fs::path& folder : folders) {
    for (const auto& entry : fs::directory_iterator(kSource / folder)) {
      if (entry.path().extension() == end) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const fs::path& file : files) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    if (text.str().size() < 100'000) texts.push_back(text.str());
  }
  return texts;
}

class Fuzz : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("faultsim-fuzz-" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override {
    if (!HasFailure()) fs::remove_all(folder_);
  }
  fs::path file(const std::string& name) const { return folder_ / name; }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }

  /// @param attempt  takes one input; may throw InputError and nothing else.
  void sieve(const std::string& name, const std::function<std::string(unsigned long)>& input,
             const std::function<void(const std::string&)>& attempt) {
    using Clock = std::chrono::steady_clock;
    const auto end =
        Clock::now() + std::chrono::duration<double>(from_environment("FAULTSIM_FUZZ_SECONDS", 5));
    const auto first = static_cast<unsigned long>(from_environment("FAULTSIM_FUZZ_FIRST", 0));
    unsigned long n = 0, n_refused = 0;
    for (; Clock::now() < end; ++n) {
      const std::string text = input(first + n);
      const std::clock_t begin = std::clock();
      std::string complaint;
      try {
        attempt(text);
      } catch (const InputError& error) {
        ++n_refused;
        for (const Problem& problem : error.problems()) {
          if (problem.what.empty()) complaint = "a problem without a text at " + problem.pointer;
        }
      } catch (const std::exception& error) {
        complaint = error.what();
      }
      const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      if (seconds > kSlowest) complaint = "took " + std::to_string(seconds) + " s";
      if (complaint.empty()) continue;
      ADD_FAILURE() << name << " " << first + n << ": " << complaint << "; the input is "
                    << write(name + "-" + std::to_string(first + n), text);
    }
    RecordProperty("inputs", std::to_string(n));
    RecordProperty("refused", std::to_string(n_refused));
    std::cout << name << ": " << n << " inputs, " << n_refused << " refused\n";
    EXPECT_GT(n_refused, 0U);
  }

 private:
  // CPU time, s. The programs promise 2; the sanitizers take five times as long.
  static constexpr double kSlowest = 10;
  fs::path folder_;
};

TEST_F(Fuzz, Scenes) {
  std::vector<std::string> corpus = texts_in(
      {"docs/examples/scenes", "docs/examples/verification", "tests/cases/bad_scenes"}, ".json");
  // One in four is of horizons or of a mesh, which are few among the others.
  const std::vector<std::string> bodies = texts_in({"tests/cases/bodies"}, ".json");
  for (std::size_t n = corpus.size() / (3 * bodies.size()); n > 0; --n)
    corpus.insert(corpus.end(), bodies.begin(), bodies.end());
  for (const char* kind : {"field", "box"}) corpus.push_back(starter_scene(kind));
  sieve(
      "scene", [&](unsigned long seed) { return Mutator(corpus, seed).json(); },
      [&](const std::string& text) {
        // CSV files are looked for where there are some.
        const std::string source = (kSource / "tests/cases/bad_scenes/fuzz.json").string();
        const JsonDocument document = parse_json(text, source);
        const Scene scene = read_scene(document);
        std::vector<Problem> problems;
        const Plan plan = make_plan(scene, problems);
        constexpr long kSmall = 5000;  // cells of a mesh that is made in an instant
        if (problems.empty() && plan.n_cells <= kSmall) problems = geometry_problems(scene, plan);
        if (!problems.empty()) throw InputError(source, problems);
        case_identity(scene);
        parameters(document);
      });
}

TEST_F(Fuzz, Specs) {
  const std::vector<std::string> corpus =
      texts_in({"docs/examples/campaigns", "tests/cases/bad_specs"}, ".json");
  const std::string source = (kSource / "docs/examples/campaigns/fuzz.json").string();
  sieve(
      "spec", [&](unsigned long seed) { return Mutator(corpus, seed).json(); },
      [&](const std::string& text) {
        const faultsweep::CampaignSpec spec = faultsweep::parse_campaign(text, source);
        spec.resolved();
        long n_rows = 0;
        for (const auto& group : spec.groups) {
          long n = 1;
          for (const auto& parameter : group.parameters) {
            n = std::min(1'000'000L, n * std::max(1, parameter.n_values()));
          }
          for (const auto& design : group.designs) n = std::max(n, design.n);
          n_rows += n;
        }
        constexpr long kFew = 12;
        if (n_rows <= kFew) faultsweep::expand(spec);
      });
}

TEST_F(Fuzz, Suites) {
  std::vector<std::string> corpus = texts_in({"docs/examples/nightly"}, ".json");
  corpus.push_back(
      R"({"format": 1, "name": "all", "campaigns": ["../campaigns/small.json"], "verification":
          ["V1"], "samples": [{"store": "s", "campaign": "c", "top": 3}], "tolerance": 1e-6,
          "tolerances": {"slip_max": 1e-3}})");
  sieve(
      "nightly", [&](unsigned long seed) { return Mutator(corpus, seed).json(); },
      [&](const std::string& text) {
        faultsweep::read_nightly_suite(write("suite.json", text).string());
      });
}

TEST_F(Fuzz, Expressions) {
  using faultsweep::Expression;
  using faultsweep::Kind;
  const faultsweep::Symbols symbols = {
      {"offset", {"offset", faultsweep::number_type(Dimension::length)}},
      {"friction_angle", {"friction_angle", faultsweep::number_type(Dimension::angle)}},
      {"ratio", {"ratio", faultsweep::number_type(Dimension::number)}},
      {"group", {"group_name", {Kind::text, {}}}},
      {"slips", {"slips", {Kind::boolean, {}}}}};
  const std::vector<std::string> corpus = {
      "offset > 150 m and friction_angle < 15 deg",
      "not (slips or group = \"a\") and offset^2 >= 4 m2",
      "max(abs(-offset), sqrt(offset * 3 m), 1.5e1 km) / (2 * 1 m) + exp(-ratio) > 0.5",
      "tan(friction_angle) * 200 bar = \"20 MPa\" and true != false",
      "log10(ratio) - -1 <= min(2, 3, ratio)^2",
      "((((((((ratio))))))))",
      "\"1 Pa s\" * offset / 1 m2"};
  sieve(
      "expression",
      [&](unsigned long seed) {
        Mutator mutator(corpus, seed);
        const std::string text = mutator.bytes();
        // Long and deep ones come by repetition.
        return seed % 50 == 0 ? text + text + std::string(seed % 3000, '(') + text : text;
      },
      [&](const std::string& text) {
        const Expression expression = Expression::parse(text, symbols);
        expression.sql();
        for (const double number : {0.0, -1.0, 1e300}) {
          expression.evaluate([&](std::size_t i) -> faultsweep::Value {
            const faultsweep::Type type = symbols.at(expression.names()[i]).type;
            if (type.kind == Kind::text) return std::string("a");
            if (type.kind == Kind::boolean) return true;
            return number;
          });
        }
      });
}

}  // namespace
}  // namespace faultsim
