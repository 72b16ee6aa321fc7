#include "simulator/result_files/field_reader.h"

#include <array>
#include <optional>

#include "simulator/common/errors.h"
#include "simulator/hdf5/datasets.h"

namespace faultsim {
namespace {

using hdf5::Handle;

/// One step of a dataset (step, point[, component]), the component fastest.
template <typename Value>
std::vector<Value> read_step(hid_t file, const std::string& path, std::size_t entry, hsize_t n,
                             hsize_t n_components, hid_t type) {
  const Handle dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, path);
  const Handle space(H5Dget_space(dataset), H5Sclose, path);
  std::array<hsize_t, 3> sizes = {};
  const int rank = H5Sget_simple_extent_ndims(space);
  const int wanted = n_components > 1 ? 3 : 2;
  if (rank != wanted) throw StorageError(concat(path, " has ", rank, " dimensions, not ", wanted));
  H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
  if (sizes[0] <= entry || sizes[1] != n || (rank == 3 && sizes[2] != n_components)) {
    throw StorageError(path + " has another size than its fault");
  }
  const std::array<hsize_t, 3> start = {entry, 0, 0}, count = {1, n, n_components};
  hdf5::check(
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
      path);
  const Handle memory(H5Screate_simple(rank, count.data(), nullptr), H5Sclose, path);
  std::vector<Value> values(n * n_components);
  hdf5::check(H5Dread(dataset, type, memory, space, H5P_DEFAULT, values.data()), path);
  return values;
}

std::vector<std::string> groups_below(hid_t file, const std::string& path) {
  const Handle group(H5Gopen2(file, path.c_str(), H5P_DEFAULT), H5Gclose, path);
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  hdf5::check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names), path);
  return names;
}

std::string text_attribute(hid_t file, const std::string& path, const std::string& name) {
  const Handle attribute(
      H5Aopen_by_name(file, path.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, path);
  const Handle type(H5Aget_type(attribute), H5Tclose, path);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) {
    throw StorageError(path + "/" + name + " is not a text of fixed length");
  }
  std::string text(H5Tget_size(type), '\0');
  hdf5::check(H5Aread(attribute, type, text.data()), path);
  return text.substr(0, text.find('\0'));
}

/// Rows of two or four points; which of both, the file knows.
std::vector<std::vector<int>> read_faces(hid_t file, const std::string& path) {
  const Handle dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, path);
  const Handle space(H5Dget_space(dataset), H5Sclose, path);
  std::array<hsize_t, 2> sizes = {};
  if (H5Sget_simple_extent_ndims(space) != 2) throw StorageError(path + " is not a table");
  H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
  const std::vector<int> corners = hdf5::read<int>(file, path, sizes[1]);
  std::vector<std::vector<int>> faces;
  for (std::size_t at = 0; at < corners.size(); at += sizes[1]) {
    const auto first = corners.begin() + static_cast<std::ptrdiff_t>(at);
    faces.emplace_back(first, first + static_cast<std::ptrdiff_t>(sizes[1]));
  }
  return faces;
}

Eigen::Matrix3Xd columns_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::Matrix3Xd>(values.data(), 3,
                                            static_cast<Eigen::Index>(values.size() / 3));
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

struct FieldReader::Impl {
  std::optional<Handle> file;
  std::vector<int> steps;
  std::vector<double> times;
  std::vector<std::string> groups;
  std::vector<StoredFault> faults;
};

FieldReader::FieldReader(const std::filesystem::path& file) : impl_(std::make_unique<Impl>()) {
  const hdf5::Session session;
  with_context([&] { return "reading " + file.string(); },
               [&] {
                 impl_->file.emplace(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
                                     "opening it");
                 const hid_t h5 = *impl_->file;
                 impl_->steps = hdf5::read<int>(h5, "/step", 1);
                 impl_->times = hdf5::read<double>(h5, "/time", 1);
                 for (const std::string& name : groups_below(h5, "/faults")) {
                   const std::string at = "/faults/" + name;
                   impl_->groups.push_back(at);
                   impl_->faults.push_back(
                       {.name = text_attribute(h5, at, "name"),
                        .points = columns_of(hdf5::read<double>(h5, at + "/geometry/points", 3)),
                        .faces = read_faces(h5, at + "/geometry/cells"),
                        .split = hdf5::read<int>(h5, at + "/geometry/split", 1)});
                   const StoredFault& fault = impl_->faults.back();
                   for (const std::vector<int>& face : fault.faces) {
                     for (const int point : face) {
                       if (point < 0 || point >= fault.points.cols())
                         throw StorageError(at + " has a face without its points");
                     }
                   }
                 }
               });
}

FieldReader::~FieldReader() {
  const hdf5::Session session;
  impl_.reset();
}

const std::vector<int>& FieldReader::steps() const { return impl_->steps; }
const std::vector<double>& FieldReader::times() const { return impl_->times; }
const std::vector<StoredFault>& FieldReader::faults() const { return impl_->faults; }

StoredFields FieldReader::fields(std::size_t fault, std::size_t entry) const {
  FAULTSIM_DEMAND(fault < impl_->faults.size() && entry < impl_->steps.size(), fault, " ", entry);
  const hdf5::Session session;
  const hid_t h5 = *impl_->file;
  const std::string at = impl_->groups[fault] + "/steps/";
  const auto n = static_cast<hsize_t>(impl_->faults[fault].points.cols());
  const auto read = [&](const char* name, hsize_t n_components) {
    return read_step<double>(h5, at + name, entry, n, n_components, H5T_NATIVE_DOUBLE);
  };
  return {.traction = columns_of(read("traction_fault", 3)),
          .slip = columns_of(read("slip_fault", 3)),
          .critical_index = vector_of(read("critical_index", 1)),
          .fault_pressure_change = vector_of(read("fault_pressure_change", 1)),
          .state = read_step<int>(h5, at + "state", entry, n, 1, H5T_NATIVE_INT)};
}

Eigen::VectorXd FieldReader::critical_index(std::size_t fault, std::size_t entry) const {
  FAULTSIM_DEMAND(fault < impl_->faults.size() && entry < impl_->steps.size(), fault, " ", entry);
  const hdf5::Session session;
  const auto n = static_cast<hsize_t>(impl_->faults[fault].points.cols());
  return vector_of(read_step<double>(*impl_->file, impl_->groups[fault] + "/steps/critical_index",
                                     entry, n, 1, H5T_NATIVE_DOUBLE));
}

}  // namespace faultsim
