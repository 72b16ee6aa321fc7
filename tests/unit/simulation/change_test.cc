// A change is read, planned and named by what it touches; it must come to what the whole changed
// document comes to, whatever was changed before.

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "simulator/reading/read_scene.h"
#include "simulator/simulation/inside.h"
#include "simulator/simulation/loaded_scene.h"
#include "simulator/simulation/simulation.h"

namespace faultsim {
namespace {

using nlohmann::json;

class Draw {
 public:
  int below(std::size_t n) { return static_cast<int>(random_() % n); }
  bool with(double probability) { return within(0, 1) < probability; }
  double within(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }
  /// A word that it may be, or a number near its value; at times one out of range, at times
  /// nonsense.
  std::string value_of(const ParameterInfo& parameter) {
    if (with(0.02)) return "nonsense";
    if (parameter.is_text) {
      std::vector<std::string> words(1);
      for (const char c : parameter.range) {
        if (c == ',') words.emplace_back();
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') words.back() += c;
      }
      return words[below(words.size())];
    }
    const std::string& text = parameter.value.empty() ? parameter.default_value : parameter.value;
    std::size_t end = 0;
    double number = 1;
    try {
      number = std::stod(text, &end);
    } catch (const std::exception&) {  // a list
      return text;
    }
    const double factor = with(0.05) ? -1000 : within(0.8, 1.2);
    const std::string unit = text.substr(end);
    return unit.empty() && number == std::round(number) && number > 1
               ? std::to_string(std::lround(number * factor))
               : std::to_string(number * factor) + unit;
  }

 private:
  std::mt19937 random_{20};
};

/// All that a scene is, but for the lines of its file.
std::vector<std::string> all_of(const LoadedScene& loaded) {
  std::vector<std::string> all = {loaded.document.value.dump(),
                                  canonical_scene(loaded.scene),
                                  loaded.identity,
                                  loaded.canonical.text(),
                                  loaded.plan.family,
                                  plan_to_text(loaded.plan),
                                  plan_to_json(loaded.plan).dump(),
                                  operator_key(loaded),
                                  loaded.scene.title,
                                  loaded.scene.tier};
  for (const Remark& remark : loaded.scene.remarks) all.push_back(remark_text(remark));
  return all;
}

/// Changes scene after scene one simulation, and a document of its own each time.
void hold_against_the_whole_way(const JsonDocument& held, int n_changes) {
  Simulation simulation;
  Inside::hold(simulation, held);
  Simulation unread;
  Inside::hold_base(unread, held);
  const std::vector<ParameterInfo> known = parameters(held);
  Draw draw;
  int n_sound = 0, n_alike = 0;
  for (int i = 0; i < n_changes; ++i) {
    Changes changes;
    JsonDocument values{"values", json::object(), {}};
    const bool small = draw.with(0.6);  // of what differs between the cases of a family
    for (int k = draw.below(4); k >= 0; --k) {
      const ParameterInfo* parameter = &known[draw.below(known.size())];
      const auto is_small = [&] {
        const auto lies_in = [&](const char* member) {
          return parameter->pointer.starts_with(std::string("/") + member + "/");
        };
        return lies_in("fault_pressure") || lies_in("faults") || lies_in("friction") ||
               lies_in("initial_state");
      };
      while (small && !is_small()) parameter = &known[draw.below(known.size())];
      const bool by_alias = !parameter->alias.empty() && draw.with(0.5);
      changes.push_back(
          {by_alias ? parameter->alias : parameter->pointer, draw.value_of(*parameter)});
      try {
        values.value[parameter->pointer] =
            value_of_text(changes.back().value, "values", parameter->pointer);
      } catch (const InputError&) {
      }
    }
    const std::vector<std::string> before = all_of(Inside::scene(simulation));
    std::string problem, expected_problem;
    LoadedScene expected;
    JsonDocument document = held;
    try {
      faultsim::apply(changes, document);
      expected = load_scene(std::move(document));
    } catch (const InputError& error) {
      expected_problem = error.what();
    }
    try {
      simulation.change(changes);
    } catch (const InputError& error) {
      problem = error.what();
    }
    std::string said;
    for (const Change& change : changes) said += change.parameter + " = " + change.value + "; ";
    ASSERT_EQ(problem, expected_problem) << said;
    ASSERT_EQ(all_of(Inside::scene(simulation)), problem.empty() ? all_of(expected) : before)
        << said;
    if (values.value.size() != changes.size()) continue;  // one twice
    bool sound = true;
    try {
      Inside::change_values(unread, values);
    } catch (const InputError&) {
      sound = false;
    }
    ASSERT_EQ(sound, problem.empty()) << said;
    if (sound) {
      ASSERT_EQ(all_of(Inside::scene(unread)), all_of(expected)) << said;
    }
    n_sound += sound;
    n_alike += expected.plan.family == before[4];
  }
  EXPECT_GT(n_sound, n_changes / 5);
  EXPECT_GT(n_alike, n_changes / 10);
}

JsonDocument starter(const std::string& kind) { return parse_json(starter_scene(kind), kind); }

TEST(Change, OfAFieldIsWhatTheWholeDocumentSays) {
  JsonDocument document = starter("field");
  set_value(document, "/tier", "screening");
  hold_against_the_whole_way(document, 100);
}

TEST(Change, OfABoxIsWhatTheWholeDocumentSays) { hold_against_the_whole_way(starter("box"), 60); }

/// Pressures that are not given as changes depend on the initial ones.
TEST(Change, OfTheInitialPressureMovesHistoriesOfAbsolutePressure) {
  JsonDocument document = starter("field");
  json& stage = document.value["stages"][0];
  stage.erase("pressure_change");
  stage["pressure"] = "150 bar";
  Simulation simulation;
  Inside::hold(simulation, document);
  const double before = Inside::scene(simulation).scene.pressure[0].pressure_change.front();
  simulation.change({{"/initial_state/water_density", "1200 kg/m3"}});
  EXPECT_LT(Inside::scene(simulation).scene.pressure[0].pressure_change.front(), before - 1e6);
  simulation.change({{"/initial_state/ratio_across", "0.8"}});
  EXPECT_EQ(Inside::scene(simulation).scene.pressure[0].pressure_change.front(), before);
}

}  // namespace
}  // namespace faultsim
