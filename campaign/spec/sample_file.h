#pragma once

#include <string>
#include <vector>

namespace faultsweep {

/// Samples of parameters that somebody else has drawn, as CSV:
///
///   friction_angle [deg], cohesion [MPa], /biot
///   18.2, 0.31, 0.92
///   ...
///
/// Commas separate; blanks around cells and empty lines mean nothing, nor do lines that begin with
/// #. Parameters without a unit are plain numbers.
struct SampleFile {
  struct Column {
    std::string name;  ///< alias or JSON Pointer of a scene parameter.
    std::string unit;  ///< "" for plain numbers.
    std::vector<double> values;
  };
  struct Trouble {
    long line = 0;  ///< from 1; 0 = of the file.
    std::string what, cure;
  };
  std::vector<Column> columns;
  long n_rows = 0;
  std::vector<Trouble> troubles;  ///< of every line; what was read is of use only where none is.
  std::string fingerprint;        ///< of the text.
};

/// Reads the text; whether the scene has such parameters is not looked at.
SampleFile parse_samples(const std::string& text);

}  // namespace faultsweep
