#include <cstdlib>
#include <new>

#include "campaign/app/commands.h"
#include "campaign/store/store.h"
#include "simulator/common/errors.h"
#include "simulator/common/version.h"

namespace faultsweep {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  faultsweep init my-sweep                      write a starter spec and scene\n"
    "  faultsweep submit my-sweep/campaign.json --dry-run\n"
    "  faultsweep submit my-sweep/campaign.json      check, expand, store\n"
    "  faultsweep run --workers 2                    start, or continue where it stopped\n"
    "  faultsweep run --hostfile hosts               on the hosts in a file, as for mpirun\n"
    "  faultsweep slurm --workers 31 --nodes 2 | sbatch      as a job on a cluster\n"
    "  faultsweep status                             from another terminal: time left, failures\n"
    "  faultsweep rank --by moment --where \"friction_angle < 25 deg\" --top 10\n"
    "  faultsweep rank --fault F2 --stage gas_storage --by slip\n"
    "  faultsweep rank --where \"F2.slides in gas_storage and not F1.slides\"\n"
    "  faultsweep show 17                            one case: stages, faults, chi history\n"
    "  faultsweep report -o report.html              all of it on one page, with pictures\n"
    "  faultsweep sheet --fault F2 -o f2.html        what an authority asks about it, on one page\n"
    "  faultsweep serve                              the store in a browser, also while it runs\n"
    "  faultsweep export -o cases.csv                all cases, for pandas or a spreadsheet\n"
    "  faultsweep compare coarse fine                two campaigns, case by case\n"
    "  faultsweep limits campaign.json               up to which pressure a fault is safe\n"
    "  faultsweep pillars pillars.csv --scene section.json -o pillars     your own faults\n"
    "  faultsweep tradeoff scene.json                what each choice costs in accuracy and time\n"
    "Campaigns are addressed by name, the newest by default; cases by number, or CAMPAIGN/NUMBER.\n"
    "Exit codes: 0 done, 1 done but some cases have no full result, 2 input, 4 disk or memory,\n"
    "            5 a difference, or nothing compared, 70 bug,\n"
    "            75 interrupted: run again to continue.";

std::filesystem::path default_store() {
  const char* given = std::getenv("FAULTSWEEP_STORE");
  return given != nullptr && *given != '\0' ? given : "faultsweep-store";
}

/// Reads the command line and returns the chosen command's exit code.
ExitCode faultsweep_main(int argc, char** argv) {
  Program program;
  CLI::App& app = program.app;
  app.require_subcommand(1);
  app.get_formatter()->column_width(24);  // texts of up to 76 columns stand beside it
  app.footer(kFooter);
  app.set_version_flag("--version", faultsim::version_text("faultsweep"));
  program.common.store = default_store();
  add_submitting(program);
  add_running(program, argc, argv);
  for (const auto add :
       {add_reading, add_samples, add_tiers, add_pictures, add_sheet, add_serving, add_limits,
        add_pillars, add_tables, add_nightly, add_tradeoff, add_caring})
    add(program);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::done : ExitCode::input;
  } catch (const faultsim::Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {  // impossible: unless what was read had been damaged
    for (const std::filesystem::path* store : program.stores) {
      if (store->empty()) continue;
      if (const auto damage = Store::damage_of(*store)) throw faultsim::StorageError(*damage);
    }
    throw;
  }
  return program.code;
}

}  // namespace
}  // namespace faultsweep

int main(int argc, char** argv) {
  return static_cast<int>(
      faultsim::run_program("faultsweep", faultsweep::faultsweep_main, argc, argv));
}
