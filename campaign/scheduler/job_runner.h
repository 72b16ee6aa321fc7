#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/store/records.h"

namespace faultsweep {

/// One case to run.
struct Job {
  std::int64_t case_id = 0;
  std::int64_t base = 0;  ///< its base scene, which the runner holds.
  std::string changes;    ///< of the base scene: a JSON object, pointer -> value.
  std::string source;     ///< for messages and relative paths: "sweep/scene.json"; the same for all
                          ///< cases, so that what is wrong with all of them is said alike.
  std::string fields_folder;  ///< where its fault fields go; "" = they are not kept.
  KeepFields keep_fields = KeepFields::none;  ///< which load steps of them.
  std::string identity = "";  ///< the simulator refuses a scene with another one; "" = any.
};

/// What a JobRunner is given besides jobs: one family at a time.
struct FamilyTask {
  int family = 0;                             ///< the manager's index.
  std::optional<double> time_limit;           ///< s per case.
  std::optional<double> operator_time_limit;  ///< s; none = by the prediction.
  double operator_seconds = 0;                ///< predicted.
  std::optional<double> memory_limit;
  int threads = 1;                            ///< of building the operator.
  KeepFields keep_fields = KeepFields::none;  ///< of the cases that come with it; not `shown`.
  std::string fields_folder;  ///< of the campaign, absolute; a case's is the one in it named CASE.
};

/// What happened to jobs since the last call.
struct JobEvents {
  struct Failure {
    RunRecord run;
    bool in_operator = false;  ///< the family's operator was under way, no case had started.
  };
  struct Completed {
    RunRecord run;       ///< without reason and result, which are in the bytes.
    std::string result;  ///< of simulator/result/result_bytes.h; whoever needs it reads it.
  };
  std::vector<Completed> completed;
  std::vector<Failure> failed;
  std::vector<std::int64_t> returned;  ///< handed back untried.
  std::vector<OperatorRecord> operators;
  std::string building;  ///< what is being done for an operator; "" = nothing else than before.
  bool empty() const {
    return completed.empty() && failed.empty() && returned.empty() && operators.empty() &&
           building.empty();
  }
};

/// Runs cases of one family at a time, on this host, without blocking. Two users: the real one
/// (LocalRunner, a simulator process) and the fake of the worker's tests.
class JobRunner {
 public:
  virtual ~JobRunner() = default;
  /// Turns to a family. @pre no jobs are left.
  virtual void begin_family(const FamilyTask& task) = 0;
  /// Lets go of the family: when it returns, the simulator's memory is free. @pre no jobs are left.
  virtual void end_family() = 0;
  /// Holds a base scene (JSON text) for the jobs that name it, as long as it lives.
  virtual void hold(std::int64_t base, const std::string& scene) = 0;
  /// @pre its base scene is held.
  virtual void add(Job job) = 0;
  /// Works for at most about timeout_ms and tells what happened. Throws ResourceError when the
  /// simulator cannot be run at all.
  virtual JobEvents work(int timeout_ms) = 0;
  /// Hands back what has not started; the case under way goes on.
  virtual void drain() = 0;
  virtual bool is_idle() const = 0;
};

}  // namespace faultsweep
