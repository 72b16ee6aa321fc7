#include "campaign/reports/export.h"

#include <nlohmann/json.hpp>
#include <set>

#include "campaign/common/names.h"
#include "campaign/query/parameters.h"
#include "campaign/query/selection.h"
#include "campaign/query/table_output.h"
#include "simulator/files/output_target.h"

namespace faultsweep {

namespace {

/// A row of a CSV file; a column that is called like an earlier one is a "parameter_" or more.
class CsvHeader {
 public:
  void add(std::string name) {
    while (!names_.insert(name).second) name = "parameter_" + name;
    line_ += (line_.empty() ? "" : ",") + csv_name(name);
  }
  std::string line() const { return line_ + "\n"; }

 private:
  std::set<std::string> names_;
  std::string line_;
};

/// A metric as a column: of mixed results what is per metre of strike stands apart.
struct Column {
  std::string name, sql;
};
std::vector<Column> columns_of(const std::vector<ScopedMetric>& metrics, Store::Kinds kinds) {
  std::vector<Column> columns;
  for (const ScopedMetric& metric : metrics) {
    if (!metric.is_extensive() || !kinds.mixed()) {
      columns.push_back({column_name(metric, kinds.plane_strain), metric.sql});
      continue;
    }
    columns.push_back(
        {column_name(metric, false), concat("iif(m.plane_strain, NULL, ", metric.sql, ")")});
    columns.push_back(
        {column_name(metric, true), concat("iif(m.plane_strain, ", metric.sql, ", NULL)")});
  }
  return columns;
}

std::string header_line(const std::vector<StoredParameter>& parameters,
                        const std::vector<Column>& columns) {
  CsvHeader header;
  for (const char* name :
       {"case", "identity", "state", "outcome", "rank_class", "reason", "activated_fault"}) {
    header.add(name);
  }
  for (const Column& column : columns) header.add(column.name);
  for (const StoredParameter& one : parameters) {
    header.add(one.name);
    if (one.dimension != Dimension::number) header.add(column_name(one.name, one.dimension));
  }
  return header.line();
}

/// Parameters as given and, where they have a unit, in SI.
std::string parameter_fields(const std::vector<StoredParameter>& parameters, const CaseRow& row) {
  std::string fields;
  auto value = row.parameters.begin();
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const bool has_it = value != row.parameters.end() && value->index == static_cast<int>(k);
    const std::string number = has_it && value->si ? exact_number(*value->si) : "";
    const bool plain = !parameters[k].is_text && parameters[k].dimension == Dimension::number;
    fields += "," + (plain ? number : csv_name(has_it ? value->text : ""));
    if (parameters[k].dimension != Dimension::number) fields += "," + number;
    if (has_it) ++value;
  }
  return fields;
}

std::string reason_of(const CaseRow& row) {
  if (!row.outcome.empty() || row.status.empty()) return row.reason;
  return row.reason.empty() ? row.status : concat(row.status, ": ", row.reason);
}

std::string export_cases(const Store& store, const CampaignInfo& campaign,
                         const ExportRequest& request, const Selection& selection,
                         Store::TableQuery query) {
  const auto& parameters = campaign.parameters;
  const std::vector<Column> columns =
      columns_of(choose_metrics(selection, request.metrics, true, creeps(store, campaign)),
                 store.kinds(campaign.id, {}));
  query.columns = {{metric_sql("activated_fault"), {}}};
  for (const Column& column : columns) query.columns.push_back({column.sql, {}});
  TableOutput output(request.target);
  output.write(header_line(parameters, columns));
  long n_rows = 0, n_without = 0, n_early = 0;
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    ++n_rows;
    n_without += row.rank_class ? 0 : 1;
    n_early += row.rank_class && !row.complete() ? 1 : 0;
    output.write(concat(row.position, ",", csv_field(row.identity), ",", row.state, ",",
                        row.outcome, ",", row.rank_class ? std::to_string(*row.rank_class) : "",
                        ",", csv_name(reason_of(row))));
    for (const Cell& cell : row.metrics) output.write("," + csv_cell(cell));
    output.write(parameter_fields(parameters, row) + "\n");
  });
  output.finish();
  return concat(n_rows, " cases of ", campaign.name, ", ", n_without, " without a result",
                request.stage.empty() ? "" : " in the stage", ", ", n_early,
                " with a history that ends early (rank_class 2 and 3)\n");
}

std::string export_histories(const Store& store, const CampaignInfo& campaign,
                             const ExportRequest& request, const Store::TableQuery& query) {
  TableOutput output(request.target);
  CsvHeader header;
  const Store::Kinds kinds = store.kinds(campaign.id, {});
  for (const std::string& name : Store::history_columns(kinds)) header.add(name);
  output.write(header.line());
  long n_rows = 0;
  store.for_each_history_row(campaign.id, query, kinds, [&](const std::vector<Cell>& cells) {
    ++n_rows;
    const char* separator = "";
    for (const Cell& cell : cells) {
      output.write(separator + csv_cell(cell));
      separator = ",";
    }
    output.write("\n");
  });
  output.finish();
  return concat(n_rows, " rows of chi histories of ", campaign.name,
                ": one per case, fault and load step\n");
}

}  // namespace

std::string export_campaign(const Store& store, const CampaignInfo& campaign,
                            const ExportRequest& request) {
  const Selection selection = make_selection(store, campaign, request.stage, request.fault);
  if (request.format != ExportFormat::salib && !request.target.empty()) {
    faultsim::require_writable_file("-o", request.target, faultsim::FileKind::text, {});
  }
  if (request.histories && (request.format != ExportFormat::csv || !request.metrics.empty())) {
    throw InputError("--histories", "histories are written as CSV, with all their columns",
                     "leave out --format and --metrics");
  }
  if (request.format == ExportFormat::dakota)
    return export_dakota(store, campaign, selection, request);
  if (request.format == ExportFormat::salib)
    return export_salib(store, campaign, selection, request);
  Store::TableQuery query = case_query(campaign, selection, request.where);
  return request.histories ? export_histories(store, campaign, request, query)
                           : export_cases(store, campaign, request, selection, std::move(query));
}

}  // namespace faultsweep
