#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "simulator/documents/json_document.h"
#include "simulator/result/result.h"
#include "simulator/result_files/field_recorder.h"
#include "simulator/scene/scene.h"
#include "simulator/simulation/simulation.h"

namespace faultsim {

/// A case that was run to be shown, with all that its pictures are drawn from.
struct ShownCase {
  JsonDocument document;  ///< the scene, its changes put in: `faultsim run` of it gives these bits.
  Scene scene;
  CaseResult result;
  FieldRecorder fields;
};

enum class QuestionState {
  building,    ///< its operator is being read or built.
  running,     ///< waits for its turn, or is run.
  done,        ///< CaseResult::outcome says how it ended.
  failed,      ///< the machine could not: no memory, no disk.
  superseded,  ///< called off, as a newer one was asked.
};

/// How far a question has come.
struct QuestionProgress {
  QuestionState state = QuestionState::running;
  /// Of building: "factorising 257,049 unknowns"; of running: "production, 40 %"; of failed: why.
  std::string says = {};
  std::shared_ptr<const ShownCase> shown = nullptr;  ///< of done.
  bool is_open() const {
    return state == QuestionState::building || state == QuestionState::running;
  }
};

/// Runs the newest of the questions that it is asked in a thread of its own, on an operator that it
/// keeps until another is needed. All functions may be called from any thread.
///
/// A newer question ends the run of the one before within milliseconds; the build of an operator
/// goes on where the newer one needs the same, else it is ended too. What is shown of a question
/// does not depend on what was asked before it.
class ResidentCase {
 public:
  /// @param cache      where operators are looked for and kept; an empty folder: nowhere.
  /// @param n_threads  for building one, and for a case as many of them as it is worth
  /// (kMostThreadsOfCase); bits do not depend on them.
  /// @param between_words  before and between those about a run.
  explicit ResidentCase(const CachePolicy& cache, int n_threads = 1,
                        std::chrono::milliseconds between_words = std::chrono::milliseconds(100));
  ~ResidentCase();  ///< ends what is under way.
  ResidentCase(const ResidentCase&) = delete;
  ResidentCase& operator=(const ResidentCase&) = delete;

  /// Asks for a scene with changes; questions before it are superseded. Throws InputError with all
  /// that is wrong with it; what was asked before goes on then. @pre number is larger than those of
  /// all questions before it, and at least 1.
  void ask(long number, JsonDocument scene, const Changes& changes);

  /// How far question number has come. @pre it was asked.
  QuestionProgress progress(long number) const;
  /// Waits until it is no longer open, at most so long.
  QuestionProgress wait(long number, std::chrono::milliseconds longest) const;
  /// Called whenever a question has come further, from the thread that runs it or, of one that is
  /// superseded, from the one that asks; the last call of each question is that it is not open any
  /// more. Set before the first is asked.
  using Listener = std::function<void(long number, const QuestionProgress&)>;
  void listen(Listener listener);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faultsim
