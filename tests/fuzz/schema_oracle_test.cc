#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "campaign/spec/spec.h"
#include "simulator/documents/schema.h"
#include "simulator/reading/read_scene.h"
#include "tests/fuzz/mutator.h"

/// Our walk over a schema against a validator of others: the same documents are refused, at the
/// same places.
namespace faultsim {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Oracle {
 public:
  explicit Oracle(const json& schema) {
    valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
    parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(schema), schema_);
  }
  /// Pointers of wrong values; a key that should not be there counts for its object.
  std::set<std::string> wrong_places(const json& document) const {
    valijson::Validator validator(valijson::Validator::kStrongTypes);
    valijson::ValidationResults results;
    const valijson::adapters::NlohmannJsonAdapter target(document);
    std::set<std::string> places;
    if (validator.validate(schema_, target, &results)) return places;
    for (const auto& error : results) {
      if (error.description.rfind("Failed to validate", 0) == 0) continue;  // a parent of one
      std::string pointer;  // of "<root>", "[faults]", "[0]"
      for (std::size_t i = 1; i < error.context.size(); ++i) {
        const std::string& step = error.context[i];
        pointer += "/" + pointer_token(step.substr(1, step.size() - 2));
      }
      places.insert(pointer);
    }
    return places;
  }

 private:
  valijson::Schema schema_;
};

std::set<std::string> our_wrong_places(const JsonDocument& document, const Schema& schema) {
  std::set<std::string> places;
  for (const Problem& one : check_schema(document, schema)) {
    if (one.what.find("control character or stray byte") != std::string::npos) continue;
    const bool key = one.what.find("is not a key of this object") != std::string::npos;
    places.insert(key ? one.pointer.substr(0, one.pointer.rfind('/')) : one.pointer);
  }
  return places;
}

std::vector<std::string> texts_in(const std::vector<fs::path>& folders) {
  std::vector<std::string> texts;
  for (const fs::path& folder : folders) {
    for (const auto& entry : fs::directory_iterator(fs::path(FAULTSIM_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".json") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      if (text.str().size() < 100'000) texts.push_back(text.str());
    }
  }
  return texts;
}

/// Of every text and 5,000 mutations of them.
void compare(const Schema& schema, const std::vector<std::string>& corpus) {
  constexpr int kMutations = 5000;
  const Oracle oracle(schema.text());
  Mutator mutator(corpus, 15);
  int n_refused = 0, n_accepted = 0, n_more = 0;
  for (std::size_t i = 0; i < corpus.size() + kMutations; ++i) {
    const std::string text = i < corpus.size() ? corpus[i] : mutator.json();
    JsonDocument document;
    try {
      document = parse_json(text, "text");
    } catch (const InputError&) {
      continue;
    }
    const std::string shown = document.value.dump(1, ' ', false, json::error_handler_t::replace);
    if (shown.find("\\u0000") != std::string::npos) continue;  // where a text ends for the oracle
    const auto theirs = oracle.wrong_places(document.value);
    const auto ours = our_wrong_places(document, schema);
    ++(theirs.empty() ? n_accepted : n_refused);
    ASSERT_EQ(ours.empty(), theirs.empty()) << shown;
    // Of `allOf` they look at nothing after the first part that fails.
    ASSERT_TRUE(std::includes(ours.begin(), ours.end(), theirs.begin(), theirs.end()))
        << testing::PrintToString(ours) << " and " << testing::PrintToString(theirs) << shown;
    n_more += ours != theirs;
  }
  EXPECT_LT(n_more, n_refused / 20);
  EXPECT_GT(n_refused, 100);
  EXPECT_GT(n_accepted, 100);
}

TEST(SchemaOracle, AgreesAboutScenes) {
  compare(scene_schema(), texts_in({"tests/cases/bad_scenes", "docs/examples/scenes",
                                    "docs/examples/verification", "simulator/scene"}));
}

TEST(SchemaOracle, AgreesAboutSpecs) {
  compare(faultsweep::campaign_schema(),
          texts_in({"tests/cases/bad_specs", "docs/examples/campaigns"}));
}

TEST(SchemaOracle, AgreesAboutNights) {
  const Schema schema(read_json_file(FAULTSIM_SOURCE_DIR "/schemas/nightly.schema.json").value);
  compare(schema, texts_in({"docs/examples/nightly"}));
}

}  // namespace
}  // namespace faultsim
