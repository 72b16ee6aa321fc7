#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <map>
#include <mutex>
#include <new>
#include <tuple>
#include <type_traits>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/output/atomic_file.h"
#include "simulator/output/hdf5_disk_driver.h"
#include "simulator/output/hdf5_support.h"
#include "simulator/output/operator_cache.h"
#include "simulator/output/operator_tables.h"

/// An operator file is an HDF5 file behind a user block of 4096 bytes. The block holds one line of
/// text with the length and checksum of all that follows, so that HDF5 never parses damaged bytes.
namespace faultsim {
namespace {

constexpr std::size_t kBlock = 4096;
constexpr hsize_t kAlignment = 64;  ///< of H in the file and so, behind a whole block, in memory.
constexpr int kOperatorFormat = 1;
constexpr const char* kH = "/h";

/// What is wrong with a file that is there but cannot be believed.
class Damage : public StorageError {
  using StorageError::StorageError;
};
/// A sound file that this version cannot use.
class OtherVersion : public StorageError {
  using StorageError::StorageError;
};

/// A whole file, mapped read-only and shared; unmapped when the last user is gone.
class Mapping {
 public:
  explicit Mapping(const std::filesystem::path& path)
      : descriptor_(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    struct stat info = {};
    if (descriptor_ < 0 || fstat(descriptor_, &info) != 0) {
      error_ = errno;
      return;
    }
    if (!S_ISREG(info.st_mode)) {
      error_ = EISDIR;
      return;
    }
    size_ = static_cast<std::size_t>(info.st_size);
    modified_ = info.st_mtim;
    if (size_ == 0) return;
    bytes_ = mmap(nullptr, size_, PROT_READ, MAP_SHARED, descriptor_, 0);
    if (bytes_ == MAP_FAILED) error_ = errno;
  }
  ~Mapping() {
    if (bytes_ != MAP_FAILED) munmap(bytes_, size_);
    if (descriptor_ >= 0) close(descriptor_);
  }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;

  int error() const { return error_; }  ///< errno of what failed, 0 when mapped.
  std::size_t size() const { return size_; }
  const std::byte* bytes() const { return static_cast<const std::byte*>(bytes_); }
  timespec modified() const { return modified_; }
  /// The path of the open file itself, whatever has become of its name.
  std::string own_path() const { return concat("/proc/self/fd/", descriptor_); }
  /// Marks the file as used now (its modification time); not being allowed to is no harm.
  void touch() {
    if (futimens(descriptor_, nullptr) != 0) return;
    struct stat info = {};
    if (fstat(descriptor_, &info) == 0) modified_ = info.st_mtim;
  }

 private:
  int descriptor_;
  int error_ = 0;
  std::size_t size_ = 0;
  timespec modified_ = {};
  void* bytes_ = MAP_FAILED;
};

std::string first_line(const std::byte* bytes, std::size_t size) {
  return concat("faultsim operator ", kOperatorFormat, " bytes ", size, " checksum ",
                fingerprint(bytes + kBlock, size - kBlock), '\n');
}

/// Demands that the bytes are those that were written. Throws Damage or OtherVersion.
void verify(const Mapping& file) {
  const std::string magic = "faultsim operator ";
  const std::string this_format = concat(magic, kOperatorFormat, ' ');
  if (file.size() < kBlock) throw Damage(concat("it has only ", file.size(), " bytes"));
  const std::string start(reinterpret_cast<const char*>(file.bytes()), this_format.size());
  if (start.compare(0, magic.size(), magic) != 0) throw Damage("it is not an operator file");
  if (start != this_format) throw OtherVersion("it has another format version");
  const std::string line = first_line(file.bytes(), file.size());
  if (std::memcmp(file.bytes(), line.data(), line.size()) != 0) {
    throw Damage("its checksum does not match its bytes");
  }
}

/// verify() once per process for a file that has not changed since.
void verify_once(const std::filesystem::path& path, Mapping& file) {
  using Key = std::tuple<std::size_t, std::int64_t, std::int64_t>;
  static std::mutex mutex;
  static std::map<std::string, Key> verified;
  const auto key = [&] {
    return Key(file.size(), file.modified().tv_sec, file.modified().tv_nsec);
  };
  {
    const std::lock_guard lock(mutex);
    const auto known = verified.find(path.string());
    if (known != verified.end() && known->second == key()) {
      file.touch();
      known->second = key();
      return;
    }
  }
  verify(file);
  file.touch();
  const std::lock_guard lock(mutex);
  verified[path.string()] = key();
}

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

/// Points op.h into the mapping, at the place where HDF5 says that the dataset lies.
void map_h(FaultOperator& op, hid_t file, std::shared_ptr<const Mapping> mapping) {
  const hdf5::Handle dataset(H5Dopen2(file, kH, H5P_DEFAULT), H5Dclose, kH);
  const hdf5::Handle space(H5Dget_space(dataset), H5Sclose, kH);
  const hdf5::Handle type(H5Dget_type(dataset), H5Tclose, kH);
  const auto n = static_cast<hsize_t>(op.geometry.n_dofs);
  hsize_t sizes[2] = {0, 0};
  if (H5Sget_simple_extent_ndims(space) == 2) {
    hdf5::check(H5Sget_simple_extent_dims(space, sizes, nullptr), kH);
  }
  if (sizes[0] != n || sizes[1] != n || H5Tequal(type, H5T_NATIVE_DOUBLE) <= 0) {
    throw Damage(concat("H is not ", n, " x ", n, " doubles"));
  }
  if (n > 0) {
    const haddr_t offset = H5Dget_offset(dataset);
    if (offset == HADDR_UNDEF || offset % kAlignment != 0 || offset > mapping->size() ||
        mapping->size() - offset < n * n * sizeof(double)) {
      throw Damage("H lies at the wrong place of the file");
    }
    const auto* values = reinterpret_cast<const double*>(mapping->bytes() + offset);
    new (&op.h) Eigen::Map<const Eigen::MatrixXd>(values, op.geometry.n_dofs, op.geometry.n_dofs);
  }
  op.h_owner = std::move(mapping);
}

/// Reads a file whose bytes are known to be sound.
FaultOperator decode(const std::shared_ptr<Mapping>& mapping) {
  const hdf5::Session session;
  const hdf5::Handle access = hdf5::file_access();
  hdf5::use_disk_driver(access, nullptr);
  const hdf5::Handle file(H5Fopen(mapping->own_path().c_str(), H5F_ACC_RDONLY, access), H5Fclose,
                          "operator file");
  const std::vector<int> versions = hdf5::read_ints(file, "/versions", 1);
  if (versions != std::vector<int>{kOperatorFormat, kNumericsVersion}) {
    throw OtherVersion("it was made by another numerics version");
  }
  OperatorTables tables;
  for_each_table(tables, ReadTables{file});
  FaultOperator op = from_tables(tables);
  map_h(op, file, mapping);
  return op;
}

/// Writes all but the user block. Throws StorageError with errno's text when the disk fails.
void encode(const FaultOperator& op, const OperatorTables& tables, const PendingFile& target) {
  int first_error = 0;
  try {
    const hdf5::Session session;
    const hdf5::Handle access = hdf5::file_access();
    hdf5::use_disk_driver(access, &first_error);
    hdf5::check(H5Pset_alignment(access, 1, kAlignment), "alignment");
    const hdf5::Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "property list");
    hdf5::check(H5Pset_userblock(creation, kBlock), "user block");
    hdf5::Handle file(H5Fcreate(target.temporary().c_str(), H5F_ACC_TRUNC, creation, access),
                      H5Fclose, target.temporary().string());
    const int versions[] = {kOperatorFormat, kNumericsVersion};
    hdf5::write_array(file, "/versions", {2}, versions, {"", "file format, numerics"});
    for_each_table(tables, WriteTables{file});
    const auto n = static_cast<hsize_t>(op.geometry.n_dofs);
    hdf5::write_array(file, kH, {n, n}, op.h.data(), {"N/m", "H, condensed stiffness"});
    file.close("closing");
  } catch (const StorageError&) {
    if (first_error == 0) throw;
  }
  if (first_error != 0) target.fail(first_error);
}

struct Differs {
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

/// Bit patterns of all tables and of H.
std::vector<std::string> digests(const OperatorTables& tables,
                                 const Eigen::Map<const Eigen::MatrixXd>& h) {
  std::vector<std::string> result;
  for_each_table(tables, Differs{result});
  result.push_back(fingerprint(h.data(), static_cast<std::size_t>(h.size()) * sizeof(double)));
  return result;
}

void check_content(const FaultOperator& op, const OperatorTables& tables) {
  FAULTSIM_DEMAND(!op.fingerprint.empty() && op.fingerprint.find('/') == std::string::npos &&
                      op.fingerprint[0] != '.',
                  "fingerprint '", op.fingerprint, "'");
  FAULTSIM_DEMAND(op.h.rows() == op.geometry.n_dofs && op.h.cols() == op.geometry.n_dofs, "H is ",
                  op.h.rows(), " x ", op.h.cols(), " for ", op.geometry.n_dofs, " dofs");
  FAULTSIM_DEMAND(op.h.allFinite(), "H holds a value that is not finite");
  for_each_table(tables, [](const char* path, const auto& values, int, const char*, const char*) {
    if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<double>>) {
      FAULTSIM_DEMAND(std::all_of(values.begin(), values.end(),
                                  [](double value) { return std::isfinite(value); }),
                      path, " holds a value that is not finite");
    }
  });
  try {
    from_tables(tables);
  } catch (const StorageError& error) {
    throw_internal("the operator is consistent", error.what(), __FILE__, __LINE__);
  }
}

std::filesystem::path file_of(const std::filesystem::path& folder, const std::string& fingerprint) {
  return folder / (fingerprint + ".h5");
}

std::string move_aside(const std::filesystem::path& path, const char* why) {
  const std::filesystem::path aside = path.string() + ".damaged";
  std::error_code error;
  std::filesystem::rename(path, aside, error);
  return concat("the operator file ", path.string(), " is damaged: ", why,
                error ? "; it cannot be moved aside (" + error.message() + ")"
                      : "; moved to " + aside.filename().string());
}

}  // namespace

void write_operator(const FaultOperator& op, const std::filesystem::path& folder) {
  const OperatorTables tables = to_tables(op);
  check_content(op, tables);
  create_folders(folder);
  PendingFile target(file_of(folder, op.fingerprint));
  encode(op, tables, target);
  const auto map_back = [&] {
    auto mapping = std::make_shared<Mapping>(target.temporary());
    if (mapping->error() != 0) target.fail(mapping->error());
    return mapping;
  };
  {
    const auto mapping = map_back();
    const std::string line = first_line(mapping->bytes(), mapping->size());
    target.write(line.data(), line.size(), 0);
  }
  target.sync();
  const auto mapping = map_back();
  with_context([&] { return concat("reading back ", target.target().string()); },
               [&] {
                 verify(*mapping);
                 const FaultOperator copy = decode(mapping);
                 if (digests(to_tables(copy), copy.h) != digests(tables, op.h)) {
                   throw StorageError("what was read is not what was written");
                 }
               });
  target.commit();
}

std::optional<FaultOperator> read_operator(const std::filesystem::path& folder,
                                           const std::string& fingerprint, std::string* remark) {
  const std::filesystem::path path = file_of(folder, fingerprint);
  const auto say = [&](std::string text) {
    if (remark != nullptr) *remark = std::move(text);
    return std::nullopt;
  };
  const auto mapping = std::make_shared<Mapping>(path);
  if (mapping->error() == ENOENT || mapping->error() == ENOTDIR) return std::nullopt;
  if (mapping->error() == ENOMEM) throw ResourceError(concat("no memory to map ", path.string()));
  if (mapping->error() == EISDIR) return say(move_aside(path, "it is no regular file"));
  if (mapping->error() != 0) {
    return say(concat("the operator file ", path.string(),
                      " is not used: it cannot be read: ", std::strerror(mapping->error())));
  }
  try {
    verify_once(path, *mapping);
    FaultOperator op = decode(mapping);
    if (op.fingerprint != fingerprint) throw Damage("it holds the operator " + op.fingerprint);
    return op;
  } catch (const OtherVersion& error) {
    return say(concat("the operator file ", path.string(), " is not used: ", error.what()));
  } catch (const StorageError& error) {
    return say(move_aside(path, error.what()));
  }
}

}  // namespace faultsim
