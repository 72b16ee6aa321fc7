#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/query/parameters.h"
#include "campaign/query/selection.h"
#include "campaign/query/table_output.h"
#include "campaign/reports/export.h"
#include "simulator/files/atomic_file.h"
#include "simulator/files/result_folder.h"

namespace faultsweep {

namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// A parameter over the cases that are exported.
struct Factor {
  StoredParameter parameter;
  int index = 0;      ///< in the campaign's parameters.
  long n_values = 0;  ///< cases that have one.
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  std::vector<std::string> words;  ///< of a parameter of words: its levels, in order of appearance.

  bool varies() const { return parameter.is_text ? words.size() > 1 : low < high; }
  /// "offset_m".
  std::string name() const { return one_word(column_name(parameter.name, parameter.dimension)); }
  std::size_t level(const std::string& word) const {
    return static_cast<std::size_t>(std::ranges::find(words, word) - words.begin());
  }
};

/// Its value of one case, a number or words; null where the case has none.
const CaseParameter* value_of(const Factor& factor, const CaseRow& row) {
  for (const CaseParameter& one : row.parameters)
    if (one.index == factor.index) return &one;
  return nullptr;
}

/// Names of what the designs vary. Derived parameters follow from these: they are not factors.
std::set<std::string> varied_by_design(const Store& store, const CampaignInfo& campaign) {
  const json spec = json::parse(store.spec_copies(campaign.id).resolved, nullptr, false);
  const json groups = spec.is_object() ? spec.value("groups", json::array()) : json::array();
  std::set<std::string> names;
  for (const json& group : groups) {
    for (const json& parameter : group.at("parameters")) names.insert(parameter.at("name"));
  }
  if (groups.size() > 1) names.insert("group");
  return names;
}

/// Reads the parameters of the chosen cases once: their ranges and levels, in the spec's order,
/// which is that of AB_1 .. AB_D of a Sobol' design.
std::vector<Factor> survey(const Store& store, const CampaignInfo& campaign,
                           Store::TableQuery query) {
  std::vector<Factor> factors;
  const std::set<std::string> names = varied_by_design(store, campaign);
  const auto& parameters = campaign.parameters;
  for (std::size_t index = 0; index < parameters.size(); ++index) {
    if (!names.contains(parameters[index].name)) continue;
    factors.push_back({});
    factors.back().parameter = parameters[index];
    factors.back().index = static_cast<int>(index);
  }
  query.columns.clear();
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    for (Factor& one : factors) {
      const CaseParameter* value = value_of(one, row);
      if (value == nullptr) continue;
      ++one.n_values;
      if (!one.parameter.is_text) {
        one.low = std::min(one.low, value->si.value());
        one.high = std::max(one.high, value->si.value());
      } else if (one.level(value->text) == one.words.size()) {
        one.words.push_back(value->text);
      }
    }
  });
  return factors;
}

/// Metrics of one kind: per metre of strike or in total.
struct StatisticsMetrics {
  std::vector<ScopedMetric> metrics;
  bool plane_strain = false;
};
StatisticsMetrics choose(const Store& store, const CampaignInfo& campaign,
                         const Selection& selection, const ExportRequest& request) {
  StatisticsMetrics chosen{choose_metrics(selection, request.metrics, false, false)};
  const Store::Kinds kinds = kinds_of(store, campaign, selection, request.where);
  for (const ScopedMetric& metric : chosen.metrics) {
    if (metric.is_extensive()) refuse_mixed(kinds, "--metrics", metric.name);
  }
  chosen.plane_strain = kinds.plane_strain;
  return chosen;
}

/// What the rows of a statistics file lack, counted.
struct Losses {
  long n_rows = 0, n_without_result = 0, n_early = 0;
  std::vector<long> n_without_metric;
  /// The metrics that statistics may take: none of them unless the history is complete.
  std::vector<double> metrics_of(const CaseRow& row) {
    ++n_rows;
    n_without_metric.resize(row.metrics.size());
    n_without_result += row.rank_class ? 0 : 1;
    n_early += row.rank_class && !row.complete() ? 1 : 0;
    std::vector<double> numbers(row.metrics.size(), kMissing);
    for (std::size_t k = 0; row.complete() && k < numbers.size(); ++k) {
      numbers[k] = number_of(row.metrics[k]);
      n_without_metric[k] += std::isnan(numbers[k]) ? 1 : 0;
    }
    return numbers;
  }
  long n_incomplete() const { return n_without_result + n_early; }
  std::string text(const std::vector<ScopedMetric>& metrics) const {
    std::string text =
        concat(n_without_result, " without a result, ", n_early, " whose history ends early");
    for (std::size_t k = 0; k < n_without_metric.size(); ++k) {
      if (n_without_metric[k] > 0) {
        text += concat(", ", n_without_metric[k], " without ", metrics[k].name);
      }
    }
    return text;
  }
};

/// Words of a level must stay different without their blanks.
void check_words(const Factor& factor) {
  std::set<std::string> seen;
  for (const std::string& word : factor.words) {
    if (seen.insert(one_word(word)).second) continue;
    throw InputError("--format",
                     concat("two values of '", factor.parameter.name, "' are both '",
                            one_word(word), "' as one word"),
                     "rename one in the spec, or export as csv");
  }
}

/// The files of a SALib export.
class SalibFolder {
 public:
  SalibFolder(const std::filesystem::path& folder, const std::vector<ScopedMetric>& metrics)
      : x_(folder / "X.txt"), cases_(folder / "cases.txt") {
    for (const ScopedMetric& metric : metrics) y_.emplace_back(folder / y_name(metric));
  }
  static std::string y_name(const MetricInfo& metric) {
    return concat("Y_", one_word(metric.name), ".txt");
  }

  void write(const CaseRow& row, const std::vector<Factor>& factors,
             const std::vector<double>& metrics) {
    std::string line;
    for (const Factor& one : factors) {
      const CaseParameter* value = value_of(one, row);
      n_holes_ += value == nullptr ? 1 : 0;
      const double number = value == nullptr        ? kMissing
                            : one.parameter.is_text ? static_cast<double>(one.level(value->text))
                                                    : value->si.value();
      line += (line.empty() ? "" : " ") + exact_number(number);
    }
    x_.write(line + "\n");
    cases_.write(std::to_string(row.position) + "\n");
    for (std::size_t k = 0; k < y_.size(); ++k) y_[k].write(exact_number(metrics[k]) + "\n");
  }
  void finish() {
    x_.finish();
    cases_.finish();
    for (TableOutput& one : y_) one.finish();
  }
  long n_holes() const { return n_holes_; }

 private:
  TableOutput x_, cases_;
  std::vector<TableOutput> y_;
  long n_holes_ = 0;
};

json problem_json(const CampaignInfo& campaign, const ExportRequest& request,
                  const std::vector<Factor>& factors, const std::vector<ScopedMetric>& metrics,
                  bool plane_strain, const Losses& losses) {
  json names = json::array(), bounds = json::array(), units = json::array();
  json levels = json::object(), outputs = json::array();
  for (const Factor& one : factors) {
    names.push_back(one.name());
    units.push_back(faultsim::si_unit(one.parameter.dimension));
    if (one.parameter.is_text) {
      levels[one.name()] = one.words;
      bounds.push_back({0, one.words.size() - 1});
    } else {
      bounds.push_back({one.low, one.high});
    }
  }
  for (std::size_t k = 0; k < metrics.size(); ++k) {
    const long n_lost = k < losses.n_without_metric.size() ? losses.n_without_metric[k] : 0;
    outputs.push_back({{"name", metrics[k].name},
                       {"unit", metric_unit(metrics[k], plane_strain)},
                       {"file", SalibFolder::y_name(metrics[k])},
                       {"n_nan", losses.n_incomplete() + n_lost}});
  }
  return {{"num_vars", factors.size()}, {"names", names},
          {"bounds", bounds},           {"units", units},
          {"levels", levels},           {"outputs", outputs},
          {"n_rows", losses.n_rows},    {"campaign", campaign.name},
          {"stage", request.stage},     {"fault", request.fault},
          {"where", request.where}};
}

std::string salib_advice(const Losses& losses, long n_holes, bool filtered, long n_excluded) {
  std::string text;
  const auto any = [](const std::vector<long>& counts) {
    return std::ranges::any_of(counts, [](long n) { return n > 0; });
  };
  if (losses.n_incomplete() > 0 || any(losses.n_without_metric) || n_holes > 0) {
    text +=
        "NaN: sobol, morris, fast, ff and dgsm need every row: run these cases again, or apply\n"
        "delta, pawn, rbd_fast or hdmr, which accept any rows, to the rows of X and Y without "
        "NaN\n";
  }
  if (n_holes > 0) text += "X has NaN too, as not every case has every parameter\n";
  if (filtered)
    text += "--where leaves out rows: this is no longer a design for sobol, morris, fast, ff\n";
  if (n_excluded > 0) {
    text += concat(n_excluded,
                   " rows of the designs are excluded by the spec and missing here: this is no",
                   " design for sobol, morris, fast, ff\n");
  }
  return text;
}

}  // namespace

std::string export_dakota(const Store& store, const CampaignInfo& campaign,
                          const Selection& selection, const ExportRequest& request) {
  const StatisticsMetrics chosen = choose(store, campaign, selection, request);
  const std::vector<ScopedMetric>& metrics = chosen.metrics;
  const Store::TableQuery query = case_query(campaign, selection, request.where, metrics);
  std::vector<Factor> factors = survey(store, campaign, query);
  std::erase_if(factors, [](const Factor& one) { return one.n_values == 0; });
  // Dakota orders its variables by type.
  std::stable_partition(factors.begin(), factors.end(),
                        [](const Factor& one) { return !one.parameter.is_text; });
  TableOutput output(request.target);
  std::string line = "%eval_id interface";
  for (const Factor& one : factors) {
    check_words(one);
    line += " " + one.name();
  }
  for (const ScopedMetric& metric : metrics) line += " " + column_name(metric, chosen.plane_strain);
  output.write(line + "\n");
  Losses losses;
  long n_written = 0, n_without_parameter = 0;
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    const std::vector<double> numbers = losses.metrics_of(row);
    line = concat(row.position, " faultsweep");
    bool whole = true;
    for (const Factor& one : factors) {
      const CaseParameter* value = value_of(one, row);
      whole = whole && value != nullptr;
      if (!whole) break;
      line +=
          " " + (one.parameter.is_text ? one_word(value->text) : exact_number(value->si.value()));
    }
    n_without_parameter += whole ? 0 : 1;
    for (const double number : numbers) {
      whole = whole && std::isfinite(number);
      line += " " + exact_number(number);
    }
    if (!whole) return;
    ++n_written;
    output.write(line + "\n");
  });
  output.finish();
  return concat(n_written, " of ", losses.n_rows, " cases of ", campaign.name, "; left out, as ",
                "Dakota cannot read NaN: ", losses.text(metrics), ", ", n_without_parameter,
                " without one of the parameters (choose a group with --where)\n");
}

std::string export_salib(const Store& store, const CampaignInfo& campaign,
                         const Selection& selection, const ExportRequest& request) {
  if (request.target.empty()) {
    throw InputError("--format", "salib output is a folder of files", "name one: -o FOLDER");
  }
  const StatisticsMetrics chosen = choose(store, campaign, selection, request);
  const std::vector<ScopedMetric>& metrics = chosen.metrics;
  Store::TableQuery query = case_query(campaign, selection, request.where, metrics);
  query.by_design_row = true;
  std::vector<Factor> factors = survey(store, campaign, query);
  std::erase_if(factors, [](const Factor& one) { return !one.varies(); });
  if (factors.empty()) {
    throw InputError("--format",
                     concat("no parameter varies over the chosen cases of ", campaign.name),
                     "choose more cases, or export as csv");
  }
  std::vector<std::string> names = {"problem.json", "X.txt", "cases.txt"};
  for (const MetricInfo& metric : metrics) names.push_back(SalibFolder::y_name(metric));
  faultsim::ResultFolder output({.option = "-o",
                                 .folder = request.target,
                                 .made_by = "faultsweep export --format salib",
                                 .names = std::move(names),
                                 .inputs = {}});
  SalibFolder folder(output.path(), metrics);
  Losses losses;
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    folder.write(row, factors, losses.metrics_of(row));
  });
  folder.finish();
  faultsim::write_text(
      output.path() / "problem.json",
      problem_json(campaign, request, factors, metrics, chosen.plane_strain, losses).dump(2) +
          "\n");
  output.commit();
  return concat(
      losses.n_rows, " rows of ", campaign.name, " in the order of the design, ", factors.size(),
      " parameters, ", metrics.size(), " metrics; NaN in Y: ", losses.text(metrics), "\n",
      salib_advice(losses, folder.n_holes(), !request.where.empty(), campaign.n_excluded));
}

}  // namespace faultsweep
