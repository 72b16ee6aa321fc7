#pragma once

#include <gtest/gtest.h>
#include <hdf5.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

/// Reads our HDF5 files with nothing of ours in between; what is not there throws and fails the
/// test.
namespace faultsim {

/// A dataset of any rank as doubles, and its shape.
struct Dataset {
  std::vector<hsize_t> shape;
  std::vector<double> values;
};

class H5File {
 public:
  explicit H5File(const std::filesystem::path& path)
      : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {
    if (file_ < 0) throw std::runtime_error("cannot open " + path.string());
  }
  ~H5File() { H5Fclose(file_); }
  H5File(const H5File&) = delete;
  H5File& operator=(const H5File&) = delete;
  hid_t id() const { return file_; }

  Dataset read(const std::string& path) const {
    Dataset result;
    const hid_t dataset = H5Dopen2(file_, path.c_str(), H5P_DEFAULT);
    if (dataset < 0) throw std::runtime_error("no dataset " + path);
    const hid_t space = H5Dget_space(dataset);
    result.shape.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, result.shape.data(), nullptr);
    result.values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    EXPECT_GE(
        H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.values.data()),
        0);
    H5Sclose(space);
    H5Dclose(dataset);
    return result;
  }
  std::string attribute(const std::string& path, const char* name) const {
    const hid_t attribute = H5Aopen_by_name(file_, path.c_str(), name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) return "(none)";
    const hid_t type = H5Aget_type(attribute);
    std::string text(H5Tget_size(type), '\0');
    H5Aread(attribute, type, text.data());
    H5Tclose(type);
    H5Aclose(attribute);
    return text;
  }
  int n_filters(const std::string& path) const {
    const hid_t dataset = H5Dopen2(file_, path.c_str(), H5P_DEFAULT);
    const hid_t creation = H5Dget_create_plist(dataset);
    const int n = H5Pget_nfilters(creation);
    H5Pclose(creation);
    H5Dclose(dataset);
    return n;
  }

 private:
  hid_t file_;
};

}  // namespace faultsim
