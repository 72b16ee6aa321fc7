#include "simulator/cache/sealed_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/files/atomic_file.h"
#include "simulator/hdf5/datasets.h"
#include "simulator/hdf5/disk_driver.h"

namespace faultsim {
namespace {

constexpr std::size_t kBlock = 4096;
constexpr hsize_t kAlignment =
    64;  ///< of arrays in the file and so, behind a whole block, in memory.

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

std::string magic(const SealedFormat& format) { return concat("faultsim ", format.name, ' '); }

std::string first_line(const SealedFormat& format, const Mapping& file) {
  const std::size_t size = file.size();
  return concat(magic(format), format.version, " bytes ", size, " checksum ",
                fingerprint(file.bytes() + kBlock, size - kBlock), '\n');
}

/// Demands that the bytes are those that were written. Throws StorageError (OtherVersion).
void verify(const SealedFormat& format, const Mapping& file) {
  const std::string any_version = magic(format);
  const std::string this_version = concat(any_version, format.version, ' ');
  if (file.size() < kBlock) throw StorageError(concat("it has only ", file.size(), " bytes"));
  const std::string start(reinterpret_cast<const char*>(file.bytes()), this_version.size());
  if (!start.starts_with(any_version)) {
    throw StorageError(concat("it is not an ", format.name, " file"));
  }
  if (start != this_version) throw OtherVersion("it has another format version");
  const std::string line = first_line(format, file);
  if (std::memcmp(file.bytes(), line.data(), line.size()) != 0) {
    throw StorageError("its checksum does not match its bytes");
  }
}

/// verify() once per process for a file that has not changed since.
void verify_once(const SealedFormat& format, const std::filesystem::path& path, Mapping& file) {
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
  verify(format, file);
  file.touch();
  const std::lock_guard lock(mutex);
  verified[path.string()] = key();
}

/// Opens the HDF5 part of sound bytes. Throws OtherVersion.
void read_content(const SealedFormat& format, const std::shared_ptr<Mapping>& mapping,
                  const std::function<void(const SealedContent&)>& decode) {
  const hdf5::Session session;
  const hdf5::Handle access = hdf5::file_access();
  hdf5::use_disk_driver(access, nullptr);
  const hdf5::Handle file(H5Fopen(mapping->own_path().c_str(), H5F_ACC_RDONLY, access), H5Fclose,
                          concat(format.name, " file"));
  const std::vector<int> versions = hdf5::read<int>(file, "/versions", 1);
  if (versions != std::vector<int>{format.version, kNumericsVersion}) {
    throw OtherVersion("it was made by another numerics version");
  }
  decode({file, mapping->bytes(), mapping->size(), mapping});
}

/// Writes all but the user block. Throws StorageError with errno's text when the disk fails.
void write_content(const SealedFormat& format, const std::function<void(hid_t)>& encode,
                   const PendingFile& target) {
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
    const int versions[] = {format.version, kNumericsVersion};
    hdf5::write_array(file, "/versions", {2}, versions, {"", "file format, numerics"});
    encode(file);
    file.close("closing");
  } catch (const StorageError&) {
    if (first_error == 0) throw;
  }
  if (first_error != 0) target.fail(first_error);
}

std::string move_aside(const SealedFormat& format, const std::filesystem::path& path,
                       const char* why) {
  const std::filesystem::path aside = path.string() + ".damaged";
  std::error_code error;
  std::filesystem::rename(path, aside, error);
  return concat("the ", format.name, " file ", path.string(), " is damaged: ", why,
                error ? "; it cannot be moved aside (" + error.message() + ")"
                      : "; moved to " + aside.filename().string());
}

}  // namespace

template <typename Scalar>
const Scalar* SealedContent::mapped(const char* path, hsize_t rows, hsize_t columns) const {
  const hdf5::Handle dataset(H5Dopen2(file_, path, H5P_DEFAULT), H5Dclose, path);
  const hdf5::Handle space(H5Dget_space(dataset), H5Sclose, path);
  const hdf5::Handle type(H5Dget_type(dataset), H5Tclose, path);
  hsize_t sizes[2] = {0, 0};
  if (H5Sget_simple_extent_ndims(space) == 2) {
    hdf5::check(H5Sget_simple_extent_dims(space, sizes, nullptr), path);
  }
  if (sizes[0] != rows || sizes[1] != columns || H5Tequal(type, hdf5::memory_type<Scalar>()) <= 0) {
    throw StorageError(
        concat(path, " is not ", rows, " x ", columns, " numbers of ", sizeof(Scalar), " bytes"));
  }
  if (rows == 0 || columns == 0) return nullptr;
  const haddr_t offset = H5Dget_offset(dataset);
  if (offset == HADDR_UNDEF || offset % kAlignment != 0 || offset > size_ ||
      size_ - offset < rows * columns * sizeof(Scalar)) {
    throw StorageError(concat(path, " lies at the wrong place of the file"));
  }
  return reinterpret_cast<const Scalar*>(bytes_ + offset);
}
template const double* SealedContent::mapped(const char*, hsize_t, hsize_t) const;
template const float* SealedContent::mapped(const char*, hsize_t, hsize_t) const;

void write_sealed(const std::filesystem::path& path, const SealedFormat& format,
                  const std::function<void(hid_t)>& encode,
                  const std::function<void(const SealedContent&)>& check) {
  PendingFile target(path);
  write_content(format, encode, target);
  const auto map_back = [&] {
    auto mapping = std::make_shared<Mapping>(target.temporary());
    if (mapping->error() != 0) target.fail(mapping->error());
    return mapping;
  };
  {
    const std::string line = first_line(format, *map_back());
    target.write(line.data(), line.size(), 0);
  }
  target.sync();
  const auto mapping = map_back();
  with_context([&] { return concat("reading back ", target.target().string()); },
               [&] {
                 verify(format, *mapping);
                 read_content(format, mapping, check);
               });
  target.commit();
}

bool read_sealed(const std::filesystem::path& path, const SealedFormat& format,
                 const std::function<void(const SealedContent&)>& decode, std::string* remark) {
  const auto say = [&](std::string text) {
    if (remark != nullptr) *remark = std::move(text);
    return false;
  };
  const auto not_used = [&](const char* why) {
    return say(concat("the ", format.name, " file ", path.string(), " is not used: ", why));
  };
  const auto mapping = std::make_shared<Mapping>(path);
  const int error = mapping->error();
  if (error == ENOENT || error == ENOTDIR) return false;
  if (error == ENOMEM) throw ResourceError(concat("no memory to map ", path.string()));
  if (error == EISDIR) return say(move_aside(format, path, "it is not a regular file"));
  if (error != 0) return not_used(concat("it cannot be read: ", std::strerror(error)).c_str());
  try {
    verify_once(format, path, *mapping);
    read_content(format, mapping, decode);
    return true;
  } catch (const OtherVersion& other) {
    return not_used(other.what());
  } catch (const StorageError& damage) {
    return say(move_aside(format, path, damage.what()));
  }
}

}  // namespace faultsim
