#include <cmath>

#include "campaign/app/commands.h"

namespace faultsweep {

void add_store(CLI::App* command, StoreArguments& common) {
  command->add_option("--store", common.store,
                      "store folder (default FAULTSWEEP_STORE or ./faultsweep-store)");
}
void add_campaign(CLI::App* command, StoreArguments& common) {
  command->add_option("campaign", common.campaign, "its name; default: the newest");
  add_store(command, common);
}
void add_case(CLI::App* command, StoreArguments& common, std::string& name) {
  command
      ->add_option("case", name,
                   "its number or the beginning of its identity; CAMPAIGN/ may precede it")
      ->required();
  command->add_option("--campaign", common.campaign, "default: the newest");
  add_store(command, common);
}
void add_where(CLI::App* command, std::string& where) {
  command->add_option(
      "--where", where,
      "only cases where this holds for metrics and parameters: \"offset > 50 m and\n"
      "slides\"; of a fault, a stage, or both: \"F2.max_slip in gas_storage > 10 mm\"");
}
void add_stage_and_fault(CLI::App* command, std::string& stage, std::string& fault) {
  command->add_option("--stage", stage, "metrics of this stage; default: the whole history");
  command->add_option("--fault", fault,
                      "metrics of this fault; default: of all faults of a case together");
}
void add_json(CLI::App* command, StoreArguments& common) {
  command->add_flag("--json", common.json, "machine-readable output on stdout");
}

void add_wide(CLI::App* command) {
  command->add_flag_callback(
      "--wide",
      [] {
        constexpr std::size_t kWithoutEnd = 100000;
        set_screen_width(kWithoutEnd);
      },
      "all columns, however wide");
}

void add_renderings(CLI::App* command, StoreArguments& common) {
  add_json(command, common);
  command
      ->add_option("--csv", common.csv,
                   "a table of the answer as CSV, SI units, all digits: its key in --json;\n"
                   "default: the first")
      ->expected(0, 1)
      ->default_str("");
  add_wide(command);
}

void add_confidence(CLI::App* command, double& confidence) {
  command->add_option("--confidence", confidence, "of the intervals (default 0.95)")
      ->check(CLI::Range(0.5, 0.9999))
      ->check(not_nan());
}

CLI::Validator not_nan() {
  return CLI::Validator(
      [](std::string& text) {
        double value = 0;
        const bool is_nan = CLI::detail::lexical_cast(text, value) && std::isnan(value);
        return is_nan ? concat("Value ", text, " is not a number") : std::string();
      },
      "");
}

void add_workers(CLI::App* command, std::optional<int>& n_workers, const char* description) {
  command->add_option("-w,--workers", n_workers, description)->check(CLI::Range(1, 10000));
}

void add_build_limits(CLI::App* command, RunOptions& options) {
  command->add_option_function<std::string>(
      "--memory",
      [&options](const std::string& size) {
        options.memory = size;
        options.memory_bytes = static_cast<double>(parse_size("--memory", size));
      },
      "per host, for operators built or held at the same time: \"12 GB\",\n"
      "0 = no limit; default: 0.9 of the memory available");
  command
      ->add_option("--threads", options.threads,
                   "for building an operator; default: the idle cores of its host. Results do\n"
                   "not depend on it")
      ->check(CLI::Range(1, 1024));
}

}  // namespace faultsweep
