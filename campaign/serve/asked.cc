#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "campaign/common/names.h"
#include "campaign/serve/route.h"
#include "simulator/common/near_miss.h"

namespace faultsweep::serve {
namespace {

constexpr int kNotFound = 404;

/// All of the text as a number; none = it is not one.
template <typename Number>
std::optional<Number> number_in(const std::string& text) {
  Number number = {};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

template <typename Number>
std::optional<Number> number_within(const char* name, const std::optional<std::string>& text,
                                    Number least, Number most) {
  if (!text) return std::nullopt;
  const auto number = number_in<Number>(*text);
  if (number && *number >= least && *number <= most) return number;
  throw HttpError(400, name, concat("\"", *text, "\" is not a number from ", least, " to ", most),
                  concat("write ", name, "=", least));
}

}  // namespace

Asked::Asked(const Route& route, const HttpRequest& request) : route_(route), request_(request) {
  std::map<std::string, int> times;
  for (const auto& one : request.query) {
    const std::string& name = one.first;
    const auto known = std::ranges::find_if(
        route.parameters, [&](const Parameter& parameter) { return parameter.name == name; });
    if (known == route.parameters.end()) {
      const std::vector names = mapped(route.parameters, &Parameter::name);
      throw HttpError(400, "parameters", concat(route.path, " has no parameter \"", name, "\""),
                      names.empty() ? "leave it out"
                                    : faultsim::suggest(name, std::vector<std::string>(
                                                                  names.begin(), names.end())));
    }
    if (++times[name] > 1 && !known->may_repeat)
      throw HttpError(400, name, "it is given more than once", "give it once");
  }
}

std::optional<std::string> Asked::given(const char* name) const {
  FAULTSIM_DEMAND(
      std::ranges::any_of(route_.parameters,
                          [&](const Parameter& one) { return std::string_view(one.name) == name; }),
      route_.path, " has no parameter ", name);
  for (const auto& [key, value] : request_.query)
    if (key == name) return value;
  return std::nullopt;
}

std::string Asked::text(const char* name) const { return given(name).value_or(""); }

std::vector<std::string> Asked::texts(const char* name) const {
  std::vector<std::string> all;
  for (const auto& [key, value] : request_.query)
    if (key == name) all.push_back(value);
  return all;
}

bool Asked::flag(const char* name) const {
  const auto word = given(name);
  if (!word) return false;
  if (contains(std::vector<std::string>{"1", "true", "yes"}, *word)) return true;
  if (contains(std::vector<std::string>{"0", "false", "no"}, *word)) return false;
  throw HttpError(400, name, concat("\"", *word, "\" is neither yes nor no"),
                  concat("write ", name, "=yes"));
}

std::optional<long> Asked::whole(const char* name, long least, long most) const {
  return number_within(name, given(name), least, most);
}

std::optional<double> Asked::number(const char* name, double least, double most) const {
  return number_within(name, given(name), least, most);
}

std::size_t Asked::word(const char* name, const std::vector<std::string>& words) const {
  const auto given_word = given(name);
  if (!given_word) return 0;
  const auto found = std::ranges::find(words, *given_word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  throw HttpError(400, name, concat("\"", *given_word, "\" is not one of its values"),
                  "write one of " + joined(words, ", "));
}

double Asked::confidence() const {
  constexpr double kUsual = 0.95, kLeast = 0.5, kMost = 0.9999;
  return number("confidence", kLeast, kMost).value_or(kUsual);
}

const std::string& Asked::in_path(const char* braces) const {
  std::string_view path(route_.path);
  path.remove_prefix(1);
  for (const std::string& part : request_.path) {
    const std::size_t end = path.find('/');
    if (path.substr(0, end).starts_with(braces)) return part;
    path.remove_prefix(end == std::string_view::npos ? path.size() : end + 1);
  }
  FAULTSIM_DEMAND(false, route_.path, " has no ", braces);
}

CampaignInfo Asked::campaign(const Store& store, bool with_counts) const {
  const std::string& name = in_path("{campaign}");
  const std::vector names = mapped(store.campaigns(), &CampaignInfo::name);
  if (contains(names, name)) return store.campaign(name, with_counts);
  throw HttpError(kNotFound, "campaign", concat("there is no campaign \"", name, "\" in the store"),
                  names.empty() ? "faultsweep submit adds one" : faultsim::suggest(name, names));
}

StoredCase Asked::stored_case(const Store& store, const CampaignInfo& campaign) const {
  try {
    return store.stored_case(campaign.id, in_path("{case}"));
  } catch (const InputError& error) {
    const Problem& problem = error.problems().front();
    throw HttpError(kNotFound, "case", problem.what, problem.cure);
  }
}

}  // namespace faultsweep::serve
