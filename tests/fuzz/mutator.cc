#include "tests/fuzz/mutator.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace faultsim {
namespace {

using nlohmann::json;

/// What has gone wrong somewhere before, and its relatives.
const std::vector<std::string>& nasty_values() {
  static const std::vector<std::string> values = {
      "null",
      "true",
      "false",
      "0",
      "-0.0",
      "1",
      "-1",
      "2.5",
      "1e-320",
      "5e-324",
      "1e-21",
      "1e300",
      "1.7e308",
      "9007199254740993",
      "-9223372036854775808",
      "18446744073709551615",
      "4294967296",
      "\"\"",
      "\" \"",
      "\"x\"",
      "\"0 m\"",
      "\"-1 m\"",
      "\"1e-320 m\"",
      "\"1e300 m\"",
      "\"1 mm\"",
      "\"1e-6 m\"",
      "\"10000 km\"",
      "\"200 bar\"",
      "\"1.7e308 Pa\"",
      "\"1e300 year\"",
      "\"1 s\"",
      "\"45 deg\"",
      "\"90 deg\"",
      "\"25 %\"",
      "\"1 degC\"",
      "\"nan m\"",
      "\"inf m\"",
      "\"0x10 m\"",
      "\"1 m m\"",
      "\"1e-3\"",
      "\"1,5 m\"",
      "\"1 \\u00b5m\"",
      "\"\\u001b[31m\"",
      "\"a\\nb\"",
      "\"\\u0000\"",
      "\"\\u202e\"",
      "\"/dev/zero\"",
      "\"/dev/null\"",
      "\"../x.csv\"",
      "\"on\"",
      "\"off\"",
      "\"automatic\"",
      "\"field\"",
      "\"box\"",
      "\"prescribed\"",
      "\"screening\"",
      "\"standard\"",
      "\"tied\"",
      "\"x-\"",
      "[]",
      "{}",
      "[[]]",
      "[null]",
      "[1, 2, 3]",
      "[\"0 m\", \"0 m\", \"0 m\"]",
      "[\"0 m\", \"100 m\"]",
      "{\"\": 1}",
      "{\"comment\": 1}",
      "{\"kind\": \"box\"}",
      "{\"time\": [\"1 year\"], \"factor\": [1]}",
      "{\"time\": [\"1 year\", \"2 year\"], \"factor\": [1]}",
      "{\"values\": [1]}",
      "{\"from\": \"0 m\", \"to\": \"1 m\", \"count\": 1000000}",
      "{\"scale\": \"offset\", \"factors\": [1e300]}",
      "[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]"};
  return values;
}

/// Every value of the document, as pointers.
void collect(const json& value, const json::json_pointer& at,
             std::vector<json::json_pointer>& all) {
  if (!at.empty()) all.push_back(at);
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) collect(inner, at / key, all);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) collect(value[i], at / i, all);
  }
}

}  // namespace

Mutator::Mutator(const std::vector<std::string>& corpus, unsigned long seed)
    : corpus_(corpus), random_(seed) {}

std::size_t Mutator::below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

std::string Mutator::json() {
  const std::string& text = pick(corpus_);
  nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
  if (document.is_discarded() || below(10) < 2) return changed_bytes(text);
  for (std::size_t n = 1 + below(4); n > 0; --n) {
    std::vector<json::json_pointer> places;
    collect(document, json::json_pointer(), places);
    if (places.empty()) break;
    const json::json_pointer place = places[below(places.size())];
    nlohmann::json& value = document.at(place);
    nlohmann::json& parent = document.at(place.parent_pointer());
    switch (below(9)) {
      case 0:  // lost
        if (parent.is_object()) parent.erase(place.back());
        if (parent.is_array()) parent.erase(std::stoul(place.back()));
        break;
      case 1:  // a key misspelt
        if (parent.is_object()) {
          std::string key = place.back();
          const nlohmann::json kept = value;
          parent.erase(key);
          if (key.size() > 1) std::swap(key[below(key.size())], key[below(key.size())]);
          parent[below(4) == 0 ? key + "x" : key] = kept;
        }
        break;
      case 2:  // repeated
        if (parent.is_array()) {
          const nlohmann::json copy = value;
          for (std::size_t k = below(3) == 0 ? 100 : 1; k > 0; --k) parent.push_back(copy);
        }
        break;
      case 3:  // from elsewhere in the document
        value = nlohmann::json(document.at(places[below(places.size())]));
        break;
      case 4:  // from another text
      {
        const nlohmann::json other = nlohmann::json::parse(pick(corpus_), nullptr, false);
        std::vector<json::json_pointer> others;
        collect(other, json::json_pointer(), others);
        if (!others.empty()) value = other.at(others[below(others.size())]);
        break;
      }
      case 5:  // another size, the same unit
        if (value.is_string()) {
          const std::string old = value.get<std::string>();
          const auto unit = old.find(' ');
          static const std::vector<std::string> numbers = {"0",   "-1",    "1e-9", "1e-320",
                                                           "1e9", "1e300", "0.5",  "7"};
          if (unit != std::string::npos) value = pick(numbers) + old.substr(unit);
        } else if (value.is_number()) {
          static const double factors[] = {-1, 0, 1e-6, 1e6, 1e300, 0.5, 3};
          value = value.get<double>() * factors[below(std::size(factors))];
        }
        break;
      case 6:  // a key too many
        if (value.is_object()) value[pick(nasty_values())] = 1;
        break;
      default:
        value = nlohmann::json::parse(pick(nasty_values()));
        break;
    }
  }
  return document.dump(below(2) == 0 ? -1 : 1);
}

std::string Mutator::bytes() { return changed_bytes(pick(corpus_)); }

std::string Mutator::changed_bytes(std::string text) {
  static const std::vector<std::string> pieces = {"{",
                                                  "}",
                                                  "[",
                                                  "]",
                                                  ",",
                                                  ":",
                                                  "\"",
                                                  "\\",
                                                  "\n",
                                                  "\r",
                                                  "\t",
                                                  " ",
                                                  std::string(1, '\0'),
                                                  "\x1b",
                                                  "\x7f",
                                                  "\xff",
                                                  "\xc2\x9b",
                                                  "\xe2\x80\xae",
                                                  "\xef\xbb\xbf",
                                                  "-",
                                                  "1e999",
                                                  "nan",
                                                  "0.5",
                                                  "(",
                                                  ")",
                                                  " and ",
                                                  " or ",
                                                  "not ",
                                                  "<",
                                                  "=",
                                                  "^",
                                                  "max(",
                                                  "bar",
                                                  " m",
                                                  ";",
                                                  "#",
                                                  "'",
                                                  "%",
                                                  "\\u0000"};
  for (std::size_t n = 1 + below(4); n > 0; --n) {
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = std::min(text.size() - at, 1 + below(8));
    switch (below(5)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, pick(pieces));
        break;
      case 2:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      case 3:
        text.insert(at, text.substr(below(text.size() + 1), below(200)));
        break;
      default:
        if (below(4) == 0) text.resize(at);  // cut off
        break;
    }
  }
  return text;
}

}  // namespace faultsim
