#include "simulator/linalg/supernodal_factor.h"

#include <cblas.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <numeric>
#include <system_error>
#include <thread>
#include <vector>

#include "simulator/common/large_pages.h"
#include "simulator/linalg/blas.h"
#include "simulator/linalg/lapack.h"
#include "simulator/linalg/panels.h"

namespace faultsim {
namespace {

using Index = SuiteSparse_long;

/// What the threads share.
struct Shared {
  Shared(const cholmod_sparse& a, cholmod_factor& factor, const PanelSchedule& panel_schedule,
         std::vector<PanelSchedule::Task> all_tasks)
      : columns(static_cast<const Index*>(a.p)),
        rows(static_cast<const Index*>(a.i)),
        entries(static_cast<const double*>(a.x)),
        supernodes(supernodes_of(factor)),
        values(static_cast<double*>(factor.x)),
        schedule(panel_schedule),
        tasks(std::move(all_tasks)),
        complete(new std::atomic<int>[panel_schedule.n_panels()]()),
        failed_column(supernodes.n),
        flops(std::accumulate(schedule.flops.begin(), schedule.flops.end(), 0.0)) {}

  const Index *columns, *rows;  ///< of A
  const double* entries;
  const Supernodes supernodes;
  double* const values;  ///< of L
  const PanelSchedule& schedule;
  const std::vector<PanelSchedule::Task> tasks;
  const std::unique_ptr<std::atomic<int>[]> complete;  ///< per panel: 1 = may be read.
  std::atomic<int> next_task = 0;
  std::atomic<bool> stopped = false;
  /// The least column without a positive pivot, n if none. Panels after it are worth nothing, those
  /// before it are still finished: one of them may hold the first.
  std::atomic<Index> failed_column;
  const double flops;
  std::atomic<double> flops_done = 0;
};

/// A panel's place in L: rows from its first column down, by column.
struct PanelView {
  double* values;
  int width, height, stride;
  const Index* rows;
};

PanelView view_of(const Shared& shared, const Columns& panel) {
  const Supernodes& l = shared.supernodes;
  const Index s = panel.supernode, stride = l.height(s);
  return {shared.values + l.value_begin[s] + panel.first * (stride + 1), panel.width,
          static_cast<int>(stride - panel.first), static_cast<int>(stride),
          l.rows_of(s) + panel.first};
}

/// c ← beta c − a a[0 … n_columns−1]ᵀ, lower part; a: n_rows x depth.
void subtract_product(const double* a, int stride, int n_rows, int n_columns, int depth,
                      double alpha, double beta, double* c, int c_stride) {
  cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, n_columns, depth, alpha, a, stride, beta, c,
              c_stride);
  if (n_rows == n_columns) return;
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, n_rows - n_columns, n_columns, depth, alpha,
              a + n_columns, stride, a, stride, beta, c + n_columns, c_stride);
}

/// One thread's share, with its own workspace.
class PanelWorker {
 public:
  explicit PanelWorker(Shared& shared)
      : shared_(shared), place_(shared.supernodes.n), product_(shared.schedule.largest_product) {}

  void work(const FactorRun& run, bool tells) {
    const int n_tasks = static_cast<int>(shared_.tasks.size());
    constexpr double kStep = 0.01;  // of progress that is worth telling
    double told = 0;
    for (int task = 0; (task = shared_.next_task.fetch_add(1)) < n_tasks;) {
      for (int p = shared_.tasks[task].first; p < shared_.tasks[task].last; ++p) {
        if (!shared_.stopped && run.stop && run.stop()) shared_.stopped = true;
        if (!shared_.stopped && first_column(p) < shared_.failed_column) finish(p);
        shared_.complete[p] = 1;  // in any case, so that nobody waits for ever
        shared_.complete[p].notify_all();
        const double done = shared_.flops_done += shared_.schedule.flops[p];
        if (tells && run.progress && done / shared_.flops > told + kStep) {
          run.progress(told = done / shared_.flops);
        }
      }
    }
  }

 private:
  Index first_column(int p) const {
    const Columns& panel = shared_.schedule.panels[p];
    return shared_.supernodes.begin[panel.supernode] + panel.first;
  }
  void await(int panel) const { shared_.complete[panel].wait(0); }

  void finish(int p) {
    const Columns& columns = shared_.schedule.panels[p];
    const PanelView panel = view_of(shared_, columns);
    for (int i = 0; i < panel.height; ++i) place_[panel.rows[i]] = i;
    take_entries(panel);
    for (long u = shared_.schedule.update_begin[p]; u < shared_.schedule.update_begin[p + 1]; ++u) {
      const PanelUpdate& update = shared_.schedule.updates[u];
      await(update.last_panel);
      subtract(update, panel);
    }
    for (int q = shared_.schedule.first_panel(columns.supernode); q < p; ++q) {
      await(q);
      const Columns& earlier = shared_.schedule.panels[q];
      const double* a = panel.values + (earlier.first - columns.first) * Index{panel.stride};
      subtract_product(a, panel.stride, panel.height, panel.width, earlier.width, -1, 1,
                       panel.values, panel.stride);
    }
    factorise(panel);
  }

  void take_entries(const PanelView& panel) {
    for (int j = 0; j < panel.width; ++j) {
      double* column = panel.values + j * Index{panel.stride};
      std::fill_n(column, panel.height, 0.0);
      for (Index k = shared_.columns[panel.rows[j]]; k < shared_.columns[panel.rows[j] + 1]; ++k) {
        column[place_[shared_.rows[k]]] = shared_.entries[k];
      }
    }
  }

  void subtract(const PanelUpdate& update, const PanelView& panel) {
    const Supernodes& l = shared_.supernodes;
    const Index s = update.source.supernode;
    const int stride = static_cast<int>(l.height(s)), n_rows = stride - update.row;
    const double* a =
        shared_.values + l.value_begin[s] + update.source.first * Index{stride} + update.row;
    const Index* rows = l.rows_of(s) + update.row;
    const int first = place_[rows[0]];
    if (place_[rows[n_rows - 1]] - first == n_rows - 1) {  // neighbours there as well
      subtract_product(a, stride, n_rows, update.n_columns, update.source.width, -1, 1,
                       panel.values + first * (Index{panel.stride} + 1), panel.stride);
      return;
    }
    subtract_product(a, stride, n_rows, update.n_columns, update.source.width, 1, 0,
                     product_.data(), n_rows);
    for (int j = 0; j < update.n_columns; ++j) {
      double* column = panel.values + place_[rows[j]] * Index{panel.stride};
      const double* product = product_.data() + j * Index{n_rows};
      for (int i = j; i < n_rows; ++i) column[place_[rows[i]]] -= product[i];
    }
  }

  void factorise(const PanelView& panel) {
    int info = 0;
    dpotrf_("L", &panel.width, panel.values, &panel.stride, &info, 1);
    if (info != 0) {
      const Index column = panel.rows[info - 1];
      Index least = shared_.failed_column;
      while (column < least && !shared_.failed_column.compare_exchange_weak(least, column)) {
      }
      return;
    }
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit,
                panel.height - panel.width, panel.width, 1, panel.values, panel.stride,
                panel.values + panel.width, panel.stride);
  }

  Shared& shared_;
  std::vector<int> place_;       ///< of a row of L in the panel at hand.
  std::vector<double> product_;  ///< of an update.
};

/// Threads that pay: each at least a few milliseconds of work.
int useful_threads(const PanelSchedule& schedule, int wanted) {
  constexpr double kFlopsPerThread = 2e8;
  const double total = std::accumulate(schedule.flops.begin(), schedule.flops.end(), 0.0);
  return static_cast<int>(std::clamp(total / kFlopsPerThread, 1.0, static_cast<double>(wanted)));
}

}  // namespace

Supernodes supernodes_of(const cholmod_factor& factor) {
  return {.n = static_cast<long>(factor.n),
          .count = static_cast<long>(factor.nsuper),
          .begin = static_cast<const Index*>(factor.super),
          .row_begin = static_cast<const Index*>(factor.pi),
          .value_begin = static_cast<const Index*>(factor.px),
          .rows = static_cast<const Index*>(factor.s),
          .values = static_cast<const double*>(factor.x)};
}

FactorOutcome factorise_supernodes(const cholmod_sparse& lower, cholmod_factor* factor,
                                   cholmod_common* common, const FactorRun& run) {
  cholmod_l_change_factor(CHOLMOD_REAL, true, true, true, true, factor, common);
  if (common->status != CHOLMOD_OK) return {};  // told by the caller, who knows what for
  ask_for_large_pages(factor->x, factor->xsize * sizeof(double));
  const PanelSchedule schedule(supernodes_of(*factor));
  const int wanted = useful_threads(schedule, run.n_threads);
  Shared shared(lower, *factor, schedule, schedule.tasks(wanted));
  std::vector<PanelWorker> workers(threads_with_blas_room(wanted), PanelWorker(shared));
  {
    std::vector<std::jthread> threads;
    try {
      for (std::size_t i = 1; i < workers.size(); ++i) {
        threads.emplace_back([&, i] { workers[i].work(run, false); });
      }
    } catch (const std::system_error&) {  // a limit on processes: those that there are will do
    }
    workers[0].work(run, true);
  }
  if (shared.stopped) return {FactorEnd::stopped};
  if (shared.failed_column < shared.supernodes.n) {
    return {FactorEnd::not_positive_definite, shared.failed_column};
  }
  return {};
}

}  // namespace faultsim
