#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "simulator/cache/cache_policy.h"
#include "simulator/common/errors.h"
#include "simulator/common/run_context.h"
#include "simulator/contact/search_record.h"
#include "simulator/loading/run_watch.h"
#include "simulator/model/fault_geometry.h"
#include "simulator/result/result.h"

/// faultsim as a library. What programs outside this project include, with the headers above:
///
///   load → plan → prepare → run, changed, as often as wanted → results, fields, trace
///
/// Errors are exceptions by kind (errors.h): InputError with every problem of a scene or its
/// changes, ResourceError, StorageError, Interrupted, and InternalError for bugs. How a case ended
/// (no convergence, unstable, interrupted) is a value: CaseResult::outcome.
namespace faultsim {

/// A value of a scene in place of the one that it has, as `faultsim run --set` takes it.
struct Change {
  std::string parameter;  ///< "/json/pointer", or an alias: "friction_angle".
  std::string value;      ///< "25 deg", "off", "0.4"; what parses as JSON is taken as such.
};
using Changes = std::vector<Change>;

/// Where an entry of FaultFields lies: column k of its matrices belongs to point k.
struct FaultPoint {
  std::string fault;         ///< its name.
  Eigen::Vector3d position;  ///< m; on the side y >= 0 where only half of a domain is modelled.
  Eigen::Vector3d normal, strike, dip;  ///< unit vectors of its frame; normal from minus to plus.
  double area;                          ///< m2; per metre of strike (m) in plane strain.
};

/// A scene that is held, and the operator that it and its changes run on.
///
/// Two simulations know nothing of each other: each may run in a thread of its own, with its own
/// settings. One simulation is for one thread at a time. Same scene and changes, same bits,
/// whatever ran before. What stays common to a process: BLAS computes with one thread and by one
/// kernel (both are set by the first simulation and are the same for all), and calls of HDF5, of
/// the unit database and of METIS, which draws from rand(), take turns.
class Simulation {
 public:
  /// @param file     a scene as `faultsim run` reads it, with the tables that it names.
  /// @param changes  for good: later changes are to the scene with these.
  /// @param exact    without its /numerics/surface, if it has one.
  static Simulation from_file(const std::string& file, const Changes& changes = {},
                              bool exact = false);
  /// @param source  what messages call the text; tables are looked for beside it.
  static Simulation from_text(std::string_view text, const std::string& source = "scene");
  Simulation();  ///< holds nothing yet.
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Another one that holds the same scene with the same changes, for another thread. It shares
  /// what is there of the operator, as long as that stays the same; what creeps it prepares for
  /// itself. Afterwards the two know nothing of each other.
  Simulation twin() const;

  /// Operators are kept in files from now on, for other runs and processes. Default: nowhere.
  void keep_operators(const CachePolicy& policy);

  /// Holds another scene, as from_text() reads it. An operator that is the same is kept, and goes
  /// on being used.
  void hold_text(std::string_view text, const std::string& source = "scene");
  /// The held scene with these changes, and none of earlier ones. Throws InputError with all that
  /// is wrong; the scene at hand is then the one before.
  void change(const Changes& changes);

  /// Throws InputError with what would be refused once the mesh is there (check_geometry()).
  void check();
  /// What will be modelled of it, why, and what it costs, as `faultsim plan` prints it.
  std::string plan_text() const;
  /// Fingerprint of the case: equal cases have equal ones, however they are spelled.
  std::string identity() const;

  /// Whether the scene at hand needs another operator than the one that is there: changes of mesh,
  /// stiffness or boundary conditions do; friction, stress, pressure and Biot coefficients do not.
  bool needs_operator() const;
  /// Reads or builds the operator of the scene at hand, unless it is there. The old one is freed
  /// first. @returns whether one was read or built: not where it comes from a surface that is
  /// there. A stop is thrown within milliseconds; what is left of the build ends by itself, at most
  /// some seconds later, and is waited for by the next one and by the destructor.
  /// @param keep_bulk  with the factor of the bulk, for displacements of the whole mesh.
  bool prepare(const RunContext& context = {}, bool keep_bulk = false);
  /// Where the faults of the scene at hand are, which fields are given on: entry k of FaultFields
  /// belongs to nodes[k]. It outlives the simulation. @pre !needs_operator()
  std::shared_ptr<const FaultGeometry> geometry() const;
  /// The nodes of all faults with the names of these, in the order of FaultFields. @pre
  /// !needs_operator()
  std::vector<FaultPoint> points() const;

  /// Runs the scene at hand, prepared first if it is not. A stop while it runs is an outcome
  /// (`interrupted`), one while the operator is prepared is thrown (Interrupted).
  CaseResult run(const RunContext& context = {}, const RunWatch& watch = {});
  /// change(), then run().
  CaseResult run(const Changes& changes, const RunContext& context = {},
                 const RunWatch& watch = {});

 private:
  friend struct Inside;  // inside.h, not installed: what programs within the project see of it
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faultsim
