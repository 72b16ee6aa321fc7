#pragma once

#include <string>
#include <vector>

/// What is stored about trades of accuracy for speed; columns: schemas/store_7.sql.
namespace faultsweep {

/// How far the cases of a campaign are off at a tier, measured on a sample of them.
struct ErrorBar {
  std::string campaign;  ///< its name in the spec.
  std::string tier;
  std::string metric;     ///< of the whole history; SI.
  std::string reference;  ///< the tier that it was measured against.
  long n_cases = 0;
  double rms = 0, largest = 0;
};

struct TradeRecord {
  double at = 0;         ///< s since 1970.
  std::string source;    ///< the scene's or spec's file.
  std::string campaign;  ///< in this store, whose cases are the choices.
  std::string program_version;
  std::string report;  ///< JSON.
  std::vector<ErrorBar> error_bars;
};

}  // namespace faultsweep
