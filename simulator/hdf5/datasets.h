#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

/// A thin layer on HDF5's C interface: handles that close themselves, errors as StorageError, and
/// the few kinds of dataset that we use. Equal content gives equal bytes: no time stamps.
namespace faultsim::hdf5 {

/// Held while HDF5 is used (the library is not thread safe); its error printing is off.
class Session {
 public:
  Session();

 private:
  std::lock_guard<std::recursive_mutex> lock_;
};

/// Owns an HDF5 identifier of any kind.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  /// Takes what an HDF5 call returned. Throws StorageError "WHAT: HDF5's reason" if it is negative.
  Handle(hid_t id, Close how, const std::string& what);
  ~Handle();
  Handle(Handle&& other) noexcept;
  Handle& operator=(Handle&&) = delete;
  operator hid_t() const { return id_; }
  /// Closes now. Throws StorageError when HDF5 fails.
  void close(const std::string& what);

 private:
  hid_t id_;
  Close close_;
};

/// Throws StorageError "WHAT: HDF5's reason" if a call's status is negative.
void check(herr_t status, const std::string& what);

/// File access with the oldest file format, so that older readers (ParaView's) open our files.
Handle file_access();
/// An empty file kept in memory; its bytes come from image().
Handle create_in_memory();
std::vector<std::byte> image(hid_t file);

/// A text attribute of an open object.
void write_text_attribute(hid_t object, const std::string& name, const std::string& text);
/// An attribute on an existing object by its path.
void write_text_attribute(hid_t file, const std::string& path, const std::string& name,
                          const std::string& text);

/// A dataset's attributes, empty ones left out.
struct About {
  std::string units;
  std::string long_name;
};

/// HDF5's type of a double, float or int in memory.
template <typename Value>
hid_t memory_type();

/// Contiguous datasets of doubles, floats or ints, little-endian; sizes are the lengths of the
/// dimensions, missing groups are created.
template <typename Value>
void write_array(hid_t file, const std::string& path, const std::vector<hsize_t>& sizes,
                 const Value* values, const About& about);
/// One string, ending with a zero byte as C's do.
void write_text(hid_t file, const std::string& path, const std::string& text);
/// Strings of fixed length, padded with zeros.
void write_texts(hid_t file, const std::string& path, const std::vector<std::string>& texts);

/// Reads a dataset of `columns` columns (1: also a plain vector) of doubles, ints or texts
/// (std::string, 1 column). Throws StorageError if it is absent or of another shape.
template <typename Value>
std::vector<Value> read(hid_t file, const std::string& path, hsize_t columns = 1);

/// A dataset (step, point, component) that grows by a step. A step is one chunk, uncompressed with
/// a fletcher32 checksum behind it, so that its numbers stand in the file as they are (offsets()).
/// n_components = 1 drops the last dimension.
class GrowingArray {
 public:
  GrowingArray(hid_t file, const std::string& path, hid_t type, hsize_t n_points,
               hsize_t n_components, const About& about);
  /// @param values  n_points x n_components, the component fastest; of the memory type given.
  void append(hid_t memory_type, const void* values);
  /// Where each step's numbers begin in the file, bytes. Flushes the file.
  std::vector<std::uint64_t> offsets() const;
  hid_t id() const { return dataset_; }

 private:
  Handle dataset_;
  std::vector<hsize_t> sizes_;
};

}  // namespace faultsim::hdf5
