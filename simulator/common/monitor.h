#pragma once

#include <string>

namespace faultsim {

/// Where progress and remarks go. Kernels never print; they tell a Monitor.
class Monitor {
 public:
  virtual ~Monitor() = default;
  /// A stage of long work: fraction in [0, 1], "factorising 257,049 unknowns".
  virtual void progress(double fraction, const std::string& what) = 0;
  /// A remark worth reading (a warning with its figures).
  virtual void note(const std::string& text) = 0;
};

/// Says nothing.
class SilentMonitor final : public Monitor {
 public:
  void progress(double, const std::string&) override {}
  void note(const std::string&) override {}
};

}  // namespace faultsim
