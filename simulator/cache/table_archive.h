#pragma once

#include <hdf5.h>

#include <string>
#include <type_traits>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/hdf5/datasets.h"

/// Archives for a list of tables, archive(path, values, columns, units, long_name): to and from
/// HDF5, and as bit patterns. Private to `cache`.
namespace faultsim {

struct ReadTables {
  hid_t file;
  void operator()(const char* path, std::vector<double>& values, int columns, const char*,
                  const char*) const {
    values = hdf5::read_doubles(file, path, static_cast<hsize_t>(columns));
  }
  void operator()(const char* path, std::vector<int>& values, int columns, const char*,
                  const char*) const {
    values = hdf5::read_ints(file, path, static_cast<hsize_t>(columns));
  }
  void operator()(const char* path, std::vector<std::string>& values, int, const char*,
                  const char*) const {
    values = hdf5::read_texts(file, path);
  }
};

struct WriteTables {
  hid_t file;
  template <typename Value>
  void operator()(const char* path, const std::vector<Value>& values, int columns,
                  const char* units, const char* long_name) const {
    const auto n_columns = static_cast<hsize_t>(columns);
    std::vector<hsize_t> sizes = {values.size() / n_columns};
    if (columns > 1) sizes.push_back(n_columns);
    FAULTSIM_DEMAND(values.size() % n_columns == 0, path, " has ", values.size(), " values");
    hdf5::write_array(file, path, sizes, values.data(), {units, long_name});
  }
  void operator()(const char* path, const std::vector<std::string>& texts, int, const char*,
                  const char*) const {
    hdf5::write_texts(file, path, texts);
  }
};

/// A digest per table, so that what was read can be held against what was written.
struct DigestTables {
  std::vector<std::string>& digests;
  template <typename Value>
  void operator()(const char*, const std::vector<Value>& values, int, const char*,
                  const char*) const {
    if constexpr (std::is_same_v<Value, std::string>) {
      std::string joined;
      for (const auto& text : values) joined += text + '\0';
      digests.push_back(fingerprint(joined));
    } else {
      digests.push_back(fingerprint(values.data(), values.size() * sizeof(Value)));
    }
  }
};

}  // namespace faultsim
