#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "simulator/app/commands.h"
#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/coupled/box_study.h"
#include "simulator/coupled/solver_study.h"
#include "simulator/files/json_text.h"
#include "simulator/linalg/blas.h"

namespace faultsim {
namespace {

/// What is to be studied, in order.
struct Study {
  std::vector<int> cells_per_metre;
  std::vector<LeadingKind> leading;
  std::vector<SchurKind> schur;
  SolverChoice common;
};

/// The kinds of the names given, "all" for every one; names that are none become problems.
template <typename Kind>
std::vector<Kind> kinds_of(const std::vector<std::string>& names, const char* option,
                           std::vector<Problem>& problems) {
  constexpr auto all = enumerators<Kind>();
  std::vector<Kind> kinds;
  for (const std::string& name : names) {
    if (name == "all") {
      kinds.insert(kinds.end(), all.begin(), all.end());
    } else if (const auto kind = named<Kind>(name)) {
      kinds.push_back(*kind);
    } else {
      problems.push_back({"", 0, concat(option, " ", name, " is not known"),
                          "choose of all, " + joined(words(Kind()), ", ")});
    }
  }
  return kinds;
}

int cells_per_metre(const std::string& h, std::vector<Problem>& problems) {
  int n = 0, length = 0;
  const bool read =
      std::sscanf(h.c_str(), "1/%d%n", &n, &length) == 1 && length == static_cast<int>(h.size());
  if (read && n >= 2 && n <= 64 && n % 2 == 0) return n;
  problems.push_back({"", 0, concat("--h ", h, " is not a cell size of the box"),
                      "write 1/2, 1/4, 1/8, 1/16, ... 1/64: the plane z = 1/2 needs cells that "
                      "divide it"});
  return 0;
}

Study read_study(const SolverStudyArguments& arguments) {
  std::vector<Problem> problems;
  Study study;
  for (const std::string& h : arguments.cell_sizes) {
    study.cells_per_metre.push_back(cells_per_metre(h, problems));
  }
  study.leading = kinds_of<LeadingKind>(arguments.leading, "--leading", problems);
  study.schur = kinds_of<SchurKind>(arguments.schur, "--schur", problems);
  if (!problems.empty()) throw InputError("faultsim solver-study", problems);
  study.common.form = arguments.form == "full" ? BlockForm::full : BlockForm::upper;
  FsaiOptions& fsai = study.common.fsai;
  if (arguments.fsai_steps > 0) fsai.steps = arguments.fsai_steps;
  if (arguments.fsai_step_size > 0) fsai.step_size = arguments.fsai_step_size;
  if (arguments.fsai_tolerance > 0) fsai.tolerance = arguments.fsai_tolerance;
  return study;
}

nlohmann::ordered_json to_json(const StudyRow& row, int n) {
  const auto count = [](int iterations) {
    return iterations < 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(iterations);
  };
  nlohmann::ordered_json out = {
      {"h", concat("1/", n)},
      {"displacement_dofs", row.n_displacements},
      {"multiplier_dofs", row.n_multipliers},
      {"leading_nonzeros", row.leading_nonzeros},
      {"constraint_nonzeros", row.constraint_nonzeros},
      {"leading", to_string(row.choice.leading)},
      {"schur", to_string(row.choice.schur)},
      {"form", to_string(row.choice.form)},
      {"fsai",
       {{"steps", row.choice.fsai.steps},
        {"step_size", row.choice.fsai.step_size},
        {"tolerance", row.choice.fsai.tolerance}}},
      {"random", {{"1e-6", count(row.random.to_1e6)}, {"1e-8", count(row.random.to_1e8)}}},
      {"physical", {{"1e-6", count(row.physical.to_1e6)}, {"1e-8", count(row.physical.to_1e8)}}},
      {"setup_s", row.setup_seconds},
      {"solve_s", row.solve_seconds},
      {"preconditioner_bytes", row.bytes}};
  if (!row.failure.empty()) out["failure"] = row.failure;
  return out;
}

void print_header() {
  std::printf(
      "                                              random rhs     physical rhs    processor, "
      "s\n");
  std::printf("%-5s %9s %8s  %-6s %-10s  %6s %6s  %6s %6s  %7s %7s %7s\n", "h", "u dofs", "λ dofs",
              "K + E", "Schur", "1e-6", "1e-8", "1e-6", "1e-8", "set-up", "solve", "MB");
}

void print_row(const StudyRow& row, int n) {
  const auto text = [](int count) { return count < 0 ? std::string("-") : std::to_string(count); };
  std::printf("%-5s %9d %8d  %-6s %-10s  %6s %6s  %6s %6s  %7.2f %7.2f %7.1f%s%s\n",
              concat("1/", n).c_str(), row.n_displacements, row.n_multipliers,
              to_string(row.choice.leading), to_string(row.choice.schur),
              text(row.random.to_1e6).c_str(), text(row.random.to_1e8).c_str(),
              text(row.physical.to_1e6).c_str(), text(row.physical.to_1e8).c_str(),
              row.setup_seconds, row.solve_seconds, row.bytes / 1e6,
              row.failure.empty() ? "" : "  ", row.failure.c_str());
  std::fflush(stdout);
}

}  // namespace

ExitCode solver_study_command(const SolverStudyArguments& arguments) {
  const Study todo = read_study(arguments);
  set_blas_threads(1);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  if (!arguments.json) print_header();
  for (const int n : todo.cells_per_metre) {
    const TwoSidedBulk bulk(box_study(n));
    const SaddlePoint j = make_saddle_point(bulk);
    for (const LeadingKind leading : todo.leading) {
      for (const SchurKind schur : todo.schur) {
        SolverChoice choice = todo.common;
        choice.leading = leading;
        choice.schur = schur;
        const StudyRow row = study(bulk, j, choice, arguments.max_iterations);
        if (arguments.json) {
          rows.push_back(to_json(row, n));
        } else {
          print_row(row, n);
        }
      }
    }
  }
  if (arguments.json) std::cout << json_text(nlohmann::ordered_json{{"rows", rows}});
  return ExitCode::done;
}

}  // namespace faultsim
