#include "simulator/hdf5/datasets.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "simulator/common/errors.h"

namespace faultsim::hdf5 {
namespace {

std::recursive_mutex& library_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

/// H5Ewalk2 visits the innermost error first; its text is the cause.
herr_t keep_first(unsigned index, const H5E_error2_t* error, void* text) {
  if (index == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

[[noreturn]] void fail(const std::string& what) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &reason);
  H5Eclear2(H5E_DEFAULT);
  throw StorageError(concat(what, ": HDF5: ", reason.empty() ? "unknown reason" : reason));
}

Handle dataset_creation() {
  Handle list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "property list");
  check(H5Pset_obj_track_times(list, 0), "time stamps off");
  return list;
}

Handle link_creation() {
  Handle list(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "property list");
  check(H5Pset_create_intermediate_group(list, 1), "groups on the way");
  return list;
}

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "text type");
  check(H5Tset_size(type, std::max<std::size_t>(length, 1)), "text type");
  check(H5Tset_strpad(type, H5T_STR_NULLPAD), "text type");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "text type");
  return type;
}

void describe(hid_t dataset, const About& about) {
  if (!about.units.empty()) write_text_attribute(dataset, "units", about.units);
  if (!about.long_name.empty()) write_text_attribute(dataset, "long_name", about.long_name);
}

void write_any(hid_t file, const std::string& path, const std::vector<hsize_t>& sizes,
               hid_t file_type, hid_t memory_type, const void* values, const About& about) {
  const Handle space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
                     H5Sclose, path);
  Handle dataset(H5Dcreate2(file, path.c_str(), file_type, space, link_creation(),
                            dataset_creation(), H5P_DEFAULT),
                 H5Dclose, path);
  if (std::ranges::find(sizes, hsize_t{0}) == sizes.end()) {
    check(H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), path);
  }
  describe(dataset, about);
  dataset.close(path);
}

/// Opens a dataset and demands (n) or (n, columns); returns it and n * columns.
std::pair<Handle, std::size_t> open_shaped(hid_t file, const std::string& path, hsize_t columns) {
  Handle dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, path);
  const Handle space(H5Dget_space(dataset), H5Sclose, path);
  const int rank = H5Sget_simple_extent_ndims(space);
  hsize_t sizes[2] = {0, 1};
  if (rank < 1 || rank > 2) throw StorageError(path + " is neither a vector nor a table");
  check(H5Sget_simple_extent_dims(space, sizes, nullptr), path);
  if (sizes[1] != columns) {
    throw StorageError(concat(path, " has ", sizes[1], " columns instead of ", columns));
  }
  return {std::move(dataset), static_cast<std::size_t>(sizes[0] * sizes[1])};
}

}  // namespace

Session::Session() : lock_(library_mutex()) { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

Handle::Handle(hid_t id, Close how, const std::string& what) : id_(id), close_(how) {
  if (id_ < 0) fail(what);
}

Handle::~Handle() {
  if (id_ >= 0) close_(id_);
}

Handle::Handle(Handle&& other) noexcept
    : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}

void Handle::close(const std::string& what) {
  check(close_(std::exchange(id_, H5I_INVALID_HID)), what);
}

void check(herr_t status, const std::string& what) {
  if (status < 0) fail(what);
}

Handle file_access() {
  Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "property list");
  check(H5Pset_libver_bounds(list, H5F_LIBVER_EARLIEST, H5F_LIBVER_LATEST), "oldest format");
  check(H5Pset_fclose_degree(list, H5F_CLOSE_STRONG), "closing rule");
  return list;
}

Handle create_in_memory() {
  constexpr std::size_t kGrowth = 1 << 20;
  const Handle access = file_access();
  check(H5Pset_fapl_core(access, kGrowth, 0), "memory driver");
  return {H5Fcreate("in memory", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "file in memory"};
}

std::vector<std::byte> image(hid_t file) {
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), "flushing the file in memory");
  const ssize_t n_bytes = H5Fget_file_image(file, nullptr, 0);
  if (n_bytes < 0) fail("size of the file in memory");
  std::vector<std::byte> bytes(static_cast<std::size_t>(n_bytes));
  if (H5Fget_file_image(file, bytes.data(), bytes.size()) < 0) fail("bytes of the file in memory");
  return bytes;
}

void write_text_attribute(hid_t object, const std::string& name, const std::string& text) {
  const Handle type = text_type(text.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, name);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, name);
  check(H5Awrite(attribute, type, text.c_str()), name);
}

void write_text_attribute(hid_t file, const std::string& path, const std::string& name,
                          const std::string& text) {
  const Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, path);
  write_text_attribute(object, name, text);
}

template <>
hid_t memory_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t memory_type<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
hid_t memory_type<int>() {
  return H5T_NATIVE_INT;
}

template <typename Value>
void write_array(hid_t file, const std::string& path, const std::vector<hsize_t>& sizes,
                 const Value* values, const About& about) {
  const hid_t file_type = std::is_same_v<Value, double>  ? H5T_IEEE_F64LE
                          : std::is_same_v<Value, float> ? H5T_IEEE_F32LE
                                                         : H5T_STD_I32LE;
  write_any(file, path, sizes, file_type, memory_type<Value>(), values, about);
}
template void write_array(hid_t, const std::string&, const std::vector<hsize_t>&, const double*,
                          const About&);
template void write_array(hid_t, const std::string&, const std::vector<hsize_t>&, const float*,
                          const About&);
template void write_array(hid_t, const std::string&, const std::vector<hsize_t>&, const int*,
                          const About&);

void write_text(hid_t file, const std::string& path, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "text type");
  check(H5Tset_size(type, text.size() + 1), "text type");
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, path);
  Handle dataset(
      H5Dcreate2(file, path.c_str(), type, space, link_creation(), dataset_creation(), H5P_DEFAULT),
      H5Dclose, path);
  check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()), path);
  dataset.close(path);
}

void write_texts(hid_t file, const std::string& path, const std::vector<std::string>& texts) {
  std::size_t length = 1;
  for (const std::string& text : texts) length = std::max(length, text.size());
  std::string padded(length * texts.size(), '\0');
  for (std::size_t i = 0; i < texts.size(); ++i) {
    std::ranges::copy(texts[i], padded.begin() + static_cast<long>(i * length));
  }
  const Handle type = text_type(length);
  write_any(file, path, {texts.size()}, type, type, padded.data(), {});
}

template <typename Value>
std::vector<Value> read(hid_t file, const std::string& path, hsize_t columns) {
  const auto [dataset, n_values] = open_shaped(file, path, columns);
  std::vector<Value> values(n_values);
  if (n_values > 0) {
    check(H5Dread(dataset, memory_type<Value>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
          path);
  }
  return values;
}
template std::vector<double> read(hid_t, const std::string&, hsize_t);
template std::vector<int> read(hid_t, const std::string&, hsize_t);

template <>
std::vector<std::string> read(hid_t file, const std::string& path, hsize_t columns) {
  const auto [dataset, n_texts] = open_shaped(file, path, columns);
  const Handle stored(H5Dget_type(dataset), H5Tclose, path);
  const std::size_t length = H5Tget_size(stored);
  if (H5Tget_class(stored) != H5T_STRING || H5Tis_variable_str(stored) != 0) {
    throw StorageError(path + " does not hold strings of fixed length");
  }
  const Handle type = text_type(length);
  std::string padded(length * n_texts, '\0');
  if (n_texts > 0) {
    check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()), path);
  }
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < n_texts; ++i) {
    const std::string text = padded.substr(i * length, length);
    texts.push_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

GrowingArray::GrowingArray(hid_t file, const std::string& path, hid_t type, hsize_t n_points,
                           hsize_t n_components, const About& about)
    : dataset_([&]() -> Handle {
        std::vector<hsize_t> start = {0, n_points}, limit = {H5S_UNLIMITED, n_points};
        std::vector<hsize_t> chunk = {1, n_points};
        if (n_components > 1) {
          for (auto* sizes : {&start, &limit, &chunk}) sizes->push_back(n_components);
        }
        const auto rank = static_cast<int>(chunk.size());
        const Handle space(H5Screate_simple(rank, start.data(), limit.data()), H5Sclose, path);
        const Handle creation = dataset_creation();
        check(H5Pset_chunk(creation, rank, chunk.data()), path);
        check(H5Pset_fletcher32(creation), path);
        return {H5Dcreate2(file, path.c_str(), type, space, link_creation(), creation, H5P_DEFAULT),
                H5Dclose, path};
      }()),
      sizes_(n_components > 1 ? std::vector<hsize_t>{0, n_points, n_components}
                              : std::vector<hsize_t>{0, n_points}) {
  describe(dataset_, about);
}

void GrowingArray::append(hid_t memory_type, const void* values) {
  std::vector<hsize_t> start(sizes_.size(), 0), count = sizes_;
  start[0] = sizes_[0]++;
  count[0] = 1;
  check(H5Dset_extent(dataset_, sizes_.data()), "growing a dataset");
  const Handle target(H5Dget_space(dataset_), H5Sclose, "dataset's shape");
  check(H5Sselect_hyperslab(target, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
        "new step");
  const Handle source(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                      H5Sclose, "step's shape");
  check(H5Dwrite(dataset_, memory_type, source, target, H5P_DEFAULT, values), "writing a step");
}

std::vector<std::uint64_t> GrowingArray::offsets() const {
  check(H5Fflush(dataset_, H5F_SCOPE_LOCAL), "flushing a dataset");
  std::vector<std::uint64_t> offsets(sizes_[0]);
  std::vector<hsize_t> start(sizes_.size(), 0);
  for (start[0] = 0; start[0] < sizes_[0]; ++start[0]) {
    unsigned skipped_filters = 0;
    haddr_t address = HADDR_UNDEF;
    hsize_t n_bytes = 0;
    check(H5Dget_chunk_info_by_coord(dataset_, start.data(), &skipped_filters, &address, &n_bytes),
          "place of a step");
    FAULTSIM_DEMAND(address != HADDR_UNDEF, "step ", start[0], " is nowhere in the file");
    offsets[start[0]] = address;
  }
  return offsets;
}

}  // namespace faultsim::hdf5
