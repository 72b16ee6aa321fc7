#include "campaign/expansion/composer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "simulator/scene/read_scene.h"

namespace faultsweep {
namespace {

constexpr std::size_t kAllChoices = 16;  ///< up to here every choice is read.
constexpr std::size_t kMaximumCorners = 128;
constexpr long kSpreadRows = 32;

/// As the texts have a number; some have -0 as 0, others not.
std::string number_text(double value) { return nlohmann::json(value).dump(); }
bool is_minus_zero(double value) { return value == 0 && std::signbit(value); }

std::set<std::size_t> leaves_of(const std::vector<std::pair<std::size_t, std::string>>& change) {
  std::set<std::size_t> leaves;
  for (const auto& [leaf, text] : change) leaves.insert(leaf);
  return leaves;
}

}  // namespace

CanonicalPieces cut_at_values(const std::string& json_text) {
  CanonicalPieces pieces;
  std::string between;
  const auto end_of_string = [&](std::size_t begin) {
    std::size_t end = begin + 1;
    while (json_text[end] != '"') end += json_text[end] == '\\' ? 2 : 1;
    return end + 1;
  };
  for (std::size_t i = 0; i < json_text.size();) {
    const char c = json_text[i];
    if (std::string_view("{}[]:,").find(c) != std::string_view::npos) {
      between += c;
      ++i;
      continue;
    }
    const std::size_t end =
        c == '"' ? end_of_string(i) : std::min(json_text.find_first_of(",]}", i), json_text.size());
    const std::string token = json_text.substr(i, end - i);
    i = end;
    if (c == '"' && i < json_text.size() && json_text[i] == ':') {
      between += token;
      continue;
    }
    pieces.between.push_back(std::move(between));
    pieces.leaves.push_back(token);
    between.clear();
  }
  pieces.between.push_back(std::move(between));
  return pieces;
}

std::vector<int> sample_choices(const Parameter& parameter, std::size_t n) {
  const int size = parameter.n_values();
  std::set<int> sample;
  if (static_cast<std::size_t>(size) <= n) {
    for (int c = 0; c < size; ++c) sample.insert(c);
    return {sample.begin(), sample.end()};
  }
  const auto smaller = [](const Choice& a, const Choice& b) {
    return a.si.value_or(0) < b.si.value_or(0);
  };
  const auto [least, most] =  // of a range: its ends
      std::minmax_element(parameter.choices.begin(), parameter.choices.end(), smaller);
  sample = {0, size - 1, static_cast<int>(least - parameter.choices.begin()),
            static_cast<int>(most - parameter.choices.begin())};
  const auto wanted = static_cast<std::int64_t>(n);
  for (std::int64_t i = 1; i < wanted && sample.size() < n; ++i) {
    sample.insert(static_cast<int>(i * size / wanted));
  }
  return {sample.begin(), sample.end()};
}

Composer::Composer(const CampaignSpec& spec, const Group& group, SceneBuilder& builder,
                   const CaseValues& values, Text text, std::vector<bool> has_effect)
    : spec_(spec),
      group_(group),
      builder_(builder),
      values_(values),
      text_of_(std::move(text)),
      has_effect_(std::move(has_effect)),
      n_rows_(count_rows(group)),
      structural_(group.parameters.size(), false) {}

std::optional<std::string> Composer::exact_text(const Row& row, const std::vector<double>& derived,
                                                std::vector<faultsim::Problem>& problems) {
  const auto scene = builder_.scene(row, derived, problems);
  if (!scene) return std::nullopt;
  std::vector<faultsim::Problem> found;
  auto text = text_of_(*scene, found);
  for (const faultsim::Problem& one : found) problems.push_back(builder_.in_spec(one, row));
  return text;
}

/// What the row's text has other than the template's; nothing if its shape differs or it is wrong.
std::optional<Composer::Difference> Composer::read_difference(const Template& one, const Row& row,
                                                              const std::vector<double>& derived) {
  std::vector<faultsim::Problem> problems;
  const auto text = exact_text(row, derived, problems);
  if (!text) return std::nullopt;
  const CanonicalPieces pieces = cut_at_values(*text);
  if (pieces.between != one.pieces.between) return std::nullopt;
  Difference difference;
  for (std::size_t i = 0; i < pieces.leaves.size(); ++i) {
    if (pieces.leaves[i] != one.pieces.leaves[i]) difference.emplace_back(i, pieces.leaves[i]);
  }
  return difference;
}

const std::optional<Composer::Difference>& Composer::difference(Template& one,
                                                                std::size_t parameter, int choice) {
  auto& known = one.effects[parameter].known;
  const auto found = known.find(choice);
  if (found != known.end()) return found->second;
  Row row = one.reference;
  row[parameter] = choice;
  return known.emplace(choice, read_difference(one, row, one.derived)).first->second;
}

/// Parameters with many values are not read one by one: if a sample shows that each value is
/// written as its SI number into the same places, so are the others.
void Composer::find_number_effects(Template& one) {
  for (std::size_t p = 0; p < group_.parameters.size(); ++p) {
    const Parameter& parameter = group_.parameters[p];
    if (is_fixed(p) || parameter.n_values() <= static_cast<int>(kAllChoices)) continue;
    std::set<std::size_t> leaves;
    bool is_number = true;
    for (const int choice : sample_choices(parameter, kAllChoices)) {
      const auto& change = difference(one, p, choice);
      if (choice == one.reference[p]) continue;
      is_number = is_number && change && !change->empty();
      if (!is_number) break;
      const auto si = parameter.si(choice);
      if (leaves.empty()) leaves = leaves_of(*change);
      is_number = si && leaves == leaves_of(*change) &&
                  std::all_of(change->begin(), change->end(),
                              [&](const auto& place) { return place.second == number_text(*si); });
    }
    if (!is_number) continue;
    one.effects[p].is_number = true;
    one.effects[p].leaves.assign(leaves.begin(), leaves.end());
  }
}

/// Derived parameters have no choices: two other values tell where they are written.
bool Composer::find_derived_leaves(Template& one) {
  std::set<std::size_t> taken;
  for (std::size_t p = 0; p < one.effects.size(); ++p) {
    for (const auto& [choice, change] : one.effects[p].known) {
      if (change) taken.merge(leaves_of(*change));
    }
  }
  for (std::size_t d = 0; d < one.derived.size(); ++d) {
    one.derived_leaves.emplace_back();
    if (!has_effect_[group_.parameters.size() + d]) continue;
    std::set<double> others;
    std::vector<double> derived;
    Row row;
    for (long i = 0; i < n_rows_ && others.size() < 2; i += std::max(1L, n_rows_ / 97)) {
      row_at(group_, i, row);
      values_.derive(row, derived);
      if (!std::isnan(derived[d]) && derived[d] != one.derived[d]) others.insert(derived[d]);
    }
    std::set<std::size_t> leaves;
    for (const double value : others) {
      derived = one.derived;
      derived[d] = value;
      const auto change = read_difference(one, one.reference, derived);
      if (!change || change->empty()) return false;
      for (const auto& [leaf, text] : *change) {
        if (text != number_text(value) || taken.count(leaf) != 0) return false;
      }
      if (!leaves.empty() && leaves != leaves_of(*change)) return false;
      leaves = leaves_of(*change);
    }
    taken.insert(leaves.begin(), leaves.end());
    one.derived_leaves.back().assign(leaves.begin(), leaves.end());
  }
  return true;
}

std::optional<Composer::Template> Composer::make_template(const Row& like) {
  Template one;
  one.reference = reference_;
  for (std::size_t p = 0; p < structural_.size(); ++p) {
    if (structural_[p]) one.reference[p] = like[p];
  }
  values_.derive(one.reference, one.derived);
  std::vector<faultsim::Problem> problems;
  const auto text = exact_text(one.reference, one.derived, problems);
  if (!text) return std::nullopt;
  one.pieces = cut_at_values(*text);
  one.effects.resize(group_.parameters.size());
  find_number_effects(one);
  if (!find_derived_leaves(one)) return std::nullopt;
  return one;
}

Composer::Template* Composer::template_of(const Row& row) {
  Row key;
  for (std::size_t p = 0; p < row.size(); ++p) {
    if (structural_[p]) key.push_back(row[p]);
  }
  auto found = templates_.find(key);
  if (found == templates_.end()) {
    // One template per row would cost more than reading the rows.
    if (static_cast<long>(templates_.size()) > std::max(8L, n_rows_ / 8)) return nullptr;
    found = templates_.emplace(key, make_template(row)).first;
  }
  return found->second ? &*found->second : nullptr;
}

/// Which parameters need templates of their own.
bool Composer::find_structure() {
  const auto one = make_template(reference_);
  if (!one) return false;
  Template probe = *one;
  const std::size_t n = group_.parameters.size();
  std::vector<std::set<std::size_t>> leaves(n);
  for (std::size_t p = 0; p < n; ++p) {
    const Parameter& parameter = group_.parameters[p];
    if (!has_effect_[p]) continue;
    for (const int choice : sample_choices(parameter, kAllChoices)) {
      const auto& change = difference(probe, p, choice);
      if (change) leaves[p].merge(leaves_of(*change));
      if (!change) structural_[p] = true;
    }
  }
  for (std::size_t p = 0; p < n; ++p) {
    for (std::size_t q = 0; q < p; ++q) {
      const bool meet = std::any_of(leaves[p].begin(), leaves[p].end(),
                                    [&](std::size_t leaf) { return leaves[q].count(leaf) != 0; });
      if (!meet || structural_[p] || structural_[q]) continue;
      const bool q_smaller = group_.parameters[q].n_values() < group_.parameters[p].n_values();
      structural_[q_smaller ? q : p] = true;
    }
  }
  return true;
}

/// All combinations of extreme values of grids, if not too many, and rows spread over the design.
std::vector<Row> Composer::rows_to_check() const {
  std::vector<Row> rows = {reference_};
  std::size_t p = 0;
  for (const Design& design : group_.designs) {
    const std::size_t end = p + design.n_parameters;
    for (; design.kind == DesignKind::grid && p < end; ++p) {
      if (!has_effect_[p]) continue;
      const Parameter& parameter = group_.parameters[p];
      const std::vector<int> ends = sample_choices(parameter, parameter.is_text ? 4 : 2);
      std::vector<Row> next;
      for (const Row& row : rows) {
        for (const int choice : ends) {
          if (!next.empty() && next.size() >= kMaximumCorners) break;
          next.push_back(row);
          next.back()[p] = choice;
        }
      }
      rows = std::move(next);
    }
    p = end;
  }
  Row row;
  for (long i = 0; i < kSpreadRows; ++i) {
    row_at(group_, i * (n_rows_ - 1) / (kSpreadRows - 1), row);
    rows.push_back(row);
  }
  return rows;
}

bool Composer::prepare(std::vector<faultsim::Problem>& problems) {
  std::vector<double> derived;
  long first = 0;
  for (; first < n_rows_; ++first) {
    row_at(group_, first, reference_);
    values_.derive(reference_, derived);
    if (values_.excluded_by(reference_, derived) < 0) break;
  }
  if (first == n_rows_ || !find_structure()) return false;
  for (const Row& row : rows_to_check()) {
    values_.derive(row, derived);
    if (values_.excluded_by(row, derived) >= 0) continue;
    std::vector<faultsim::Problem> found;
    const auto exact = exact_text(row, derived, found);
    for (faultsim::Problem& one : found) {
      one.what += " (where " + builder_.describe(row) + ")";
      problems.push_back(one);
    }
    if (!exact) continue;
    const auto composed = text(row, derived);
    if (composed && *composed != *exact) return false;
  }
  return true;
}

/// Puts together what no row seen so far changes, so that a text is made of few parts.
void Composer::add_places(Template& one) {
  std::set<std::size_t> places(one.places.begin(), one.places.end());
  for (const auto& [leaf, text] : changes_) places.insert(leaf);
  if (places.size() == one.places.size() && !one.between.empty()) return;
  one.places.assign(places.begin(), places.end());
  one.between.assign(1, "");
  for (std::size_t i = 0; i < one.pieces.leaves.size(); ++i) {
    one.between.back() += one.pieces.between[i];
    if (places.contains(i)) {
      one.between.emplace_back();
    } else {
      one.between.back() += one.pieces.leaves[i];
    }
  }
  one.between.back() += one.pieces.between.back();
}

/// Fills changes_; false where the scene must be read.
bool Composer::find_changes(Template& one, const Row& row, const std::vector<double>& derived) {
  changes_.clear();
  numbers_.clear();
  numbers_.reserve(row.size() + derived.size());  // views of them must stay
  const auto change = [&](const std::vector<std::size_t>& leaves, double number) {
    numbers_.push_back(number_text(number));
    for (const std::size_t leaf : leaves) changes_.emplace_back(leaf, numbers_.back());
  };
  for (std::size_t p = 0; p < row.size(); ++p) {
    if (is_fixed(p) || row[p] == one.reference[p]) continue;
    const Effect& effect = one.effects[p];
    if (effect.is_number && row[p] >= 0) {
      const double si = *group_.parameters[p].si(row[p]);
      if (is_minus_zero(si)) return false;
      change(effect.leaves, si);
      continue;
    }
    const auto& known = difference(one, p, row[p]);
    if (!known) return false;
    changes_.insert(changes_.end(), known->begin(), known->end());
  }
  for (std::size_t d = 0; d < derived.size(); ++d) {
    if (!has_effect_[row.size() + d]) continue;
    if (std::isnan(derived[d]) || std::isnan(one.derived[d]) || is_minus_zero(derived[d])) {
      return false;
    }
    if (derived[d] == one.derived[d]) continue;
    if (one.derived_leaves[d].empty()) return false;
    change(one.derived_leaves[d], derived[d]);
  }
  return true;
}

std::optional<std::string_view> Composer::text(const Row& row, const std::vector<double>& derived) {
  Template* one = template_of(row);
  if (one == nullptr || !find_changes(*one, row, derived)) return std::nullopt;
  add_places(*one);
  text_ = one->between.front();
  for (std::size_t k = 0; k < one->places.size(); ++k) {
    const std::size_t leaf = one->places[k];
    const auto changed = std::find_if(changes_.rbegin(), changes_.rend(),
                                      [&](const auto& place) { return place.first == leaf; });
    text_ +=
        changed == changes_.rend() ? std::string_view(one->pieces.leaves[leaf]) : changed->second;
    text_ += one->between[k + 1];
  }
  return text_;
}

}  // namespace faultsweep
