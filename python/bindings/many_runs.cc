#include "python/bindings/many_runs.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>

#include "python/bindings/many_checks.h"
#include "simulator/common/errors.h"
#include "simulator/result/result_fields.h"
#include "simulator/simulation/inside.h"

namespace faultsim::python {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// "0.43633231299858238 rad": 17 digits read back as the same bits.
std::string text_of(double value, const std::string& unit) {
  char text[32];
  const int length = std::snprintf(text, sizeof text, "%.17g", value);
  std::string all(text, static_cast<std::size_t>(length));
  return unit.empty() ? all : all + " " + unit;
}

/// The cases of a request, handed out one by one to threads, and their numbers.
class Runs {
 public:
  Runs(const Simulation& simulation, const ManyRequest& request, StopToken stop,
       std::atomic<long>& done);

  /// Runs what nobody has taken yet, until nothing is left, somebody failed or all is to stop.
  void work(Simulation& simulation) noexcept;
  ManyResults finish();

 private:
  Changes changes_of(Eigen::Index i) const;
  void run_one(Simulation& simulation, Eigen::Index i);
  void keep(Eigen::Index i, const CaseResult& result);

  const ManyRequest& request_;
  StopToken stop_;
  std::atomic<long>& done_;
  std::atomic<Eigen::Index> next_ = 0;
  std::atomic<bool> has_failed_ = false;
  std::vector<OutputColumn> columns_;
  std::mutex mutex_;  ///< of all below; other members of results are of one case each.
  std::exception_ptr failure_;
  Eigen::Index failed_at_ = 0;
  ManyResults results_;
};

Runs::Runs(const Simulation& simulation, const ManyRequest& request, StopToken stop,
           std::atomic<long>& done)
    : request_(request),
      stop_(stop),
      done_(done),
      columns_(checked_columns(Inside::scene(simulation), request)) {
  const auto n_outputs = static_cast<Eigen::Index>(columns_.size());
  // Memory that nobody has touched costs nothing: each case fills its own, so that a stop is heard
  // at once whatever the number of cases.
  results_.outputs.resize(request.n_cases, n_outputs);
  results_.outcomes.assign(static_cast<std::size_t>(request.n_cases), Outcome::failed);
  results_.n_steps = Inside::scene(simulation).plan.n_steps + 1;
  results_.n_faults = static_cast<Eigen::Index>(Inside::scene(simulation).scene.faults.size());
  results_.histories.resize(
      results_.n_steps * results_.n_faults * static_cast<Eigen::Index>(request.histories.size()),
      request.n_cases);
  results_.times.assign(static_cast<std::size_t>(results_.n_steps), kNoNumber);
}

Changes Runs::changes_of(Eigen::Index i) const {
  Changes changes;
  changes.reserve(request_.parameters.size());
  for (const VariedParameter& one : request_.parameters) {
    changes.push_back({one.name, one.values != nullptr ? text_of(one.values[i], one.unit)
                                                       : one.texts[static_cast<std::size_t>(i)]});
  }
  return changes;
}

void Runs::work(Simulation& simulation) noexcept {
  while (!stop_.requested() && !has_failed_) {
    const Eigen::Index i = next_++;
    if (i >= request_.n_cases) return;
    try {
      run_one(simulation, i);
      ++done_;
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_ || i < failed_at_) {
        failure_ = std::current_exception();
        failed_at_ = i;
      }
      has_failed_ = true;
    }
  }
}

void Runs::run_one(Simulation& simulation, Eigen::Index i) {
  results_.outputs.row(i).setConstant(kNoNumber);
  results_.histories.col(i).setConstant(kNoNumber);
  try {
    RunContext context;
    context.stop = stop_;
    simulation.change(changes_of(i));
    keep(i, simulation.run(context));
  } catch (InputError& error) {
    if (!request_.keeps_going) {
      error.add_context(concat("running case ", i, " of ", request_.n_cases, ", counted from 0"));
      throw;
    }
    const std::lock_guard lock(mutex_);
    results_.refused[i] = error.what();
  }
}

void Runs::keep(Eigen::Index i, const CaseResult& result) {
  const auto place = static_cast<std::size_t>(i);
  results_.outcomes[place] = result.outcome;
  for (std::size_t c = 0; c < columns_.size(); ++c)
    results_.outputs(i, static_cast<Eigen::Index>(c)) = columns_[c].of(result);
  const std::size_t n_kept = request_.histories.size();
  const auto n_faults = static_cast<std::size_t>(results_.n_faults);
  double* history = results_.histories.col(i).data();
  const auto n_steps = static_cast<std::size_t>(results_.n_steps);
  for (std::size_t s = 0; s < std::min(result.steps.size(), n_steps); ++s) {
    if (i == 0) results_.times[s] = result.steps[s].time;
    for (std::size_t f = 0; f < result.steps[s].faults.size(); ++f) {
      for_each_field(result.steps[s].faults[f], [&](const Field& field, const auto& value) {
        for (std::size_t h = 0; h < n_kept; ++h) {
          if (field.key == request_.histories[h])
            history[(s * n_faults + f) * n_kept + h] = static_cast<double>(value);
        }
      });
    }
  }
}

ManyResults Runs::finish() {
  stop_.throw_if_requested("running many cases");
  if (failure_) std::rethrow_exception(failure_);
  return std::move(results_);
}

}  // namespace

ManyResults run_many(Simulation& simulation, const ManyRequest& request, int threads,
                     StopToken stop, std::atomic<long>& done) {
  simulation.change({});
  Runs runs(simulation, request, stop, done);
  if (threads > 1 && request.n_cases > 1) {  // one operator for all, unless cases have their own
    RunContext context;
    context.stop = stop;
    context.n_threads = threads;
    simulation.prepare(context);
  }
  std::vector<Simulation> twins;
  for (int t = 1; t < threads && t < request.n_cases; ++t) twins.push_back(simulation.twin());
  {
    std::vector<std::jthread> others;
    for (Simulation& twin : twins) others.emplace_back([&runs, &twin] { runs.work(twin); });
    runs.work(simulation);
  }
  return runs.finish();
}

}  // namespace faultsim::python
