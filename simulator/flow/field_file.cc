#include "simulator/flow/field_file.h"

#include <algorithm>
#include <mutex>
#include <string_view>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/input_file.h"
#include "simulator/flow/eclipse_files.h"
#include "simulator/flow/eclipse_result.h"
#include "simulator/flow/flow_csv.h"

namespace faultsim {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostCopiedBytes = 1'000'000'000;  // of tables; larger ones are mapped
constexpr std::size_t kMostKeptBytes = 1'000'000'000;

/// The files of a result as they stood when they were read.
struct Stamp {
  struct File {
    fs::path path;
    std::uintmax_t n_bytes = 0;
    fs::file_time_type time;
    bool operator==(const File&) const = default;
  };
  std::vector<File> files;
  FlowQuantity quantity = FlowQuantity::pressure;
  bool operator==(const Stamp&) const = default;
};

std::vector<fs::path> files_of(const fs::path& path) {
  if (!is_eclipse_name(path)) return {path};
  EclipseFiles eclipse = eclipse_files(path);
  std::error_code error;
  if (fs::is_regular_file(eclipse.init, error))  // says the unit of length (eclipse_length)
    eclipse.restarts.insert(eclipse.restarts.begin(), eclipse.init);
  eclipse.restarts.insert(eclipse.restarts.begin(), eclipse.grid);
  return eclipse.restarts;
}

Stamp stamp_of(const fs::path& path, FlowQuantity quantity) {
  Stamp stamp{{}, quantity};
  std::error_code error;
  for (const fs::path& file : files_of(path)) {
    stamp.files.push_back({fs::weakly_canonical(file, error), fs::file_size(file, error),
                           fs::last_write_time(file, error)});
  }
  return stamp;
}

std::size_t bytes_of(const FlowField& field) {
  return field.cells.size() * sizeof(FlowCell) +
         static_cast<std::size_t>(field.value.size()) * sizeof(double);
}

/// What was read last, the latest first.
class KeptFiles {
 public:
  FieldFile get(const fs::path& path, FlowQuantity quantity) {
    const std::lock_guard lock(mutex_);
    const Stamp stamp = stamp_of(path, quantity);
    const auto known = std::ranges::find(kept_, stamp, &Kept::stamp);
    if (known != kept_.end()) {
      std::rotate(kept_.begin(), known, known + 1);
    } else {
      kept_.insert(kept_.begin(), {stamp, read(path, quantity)});
      forget();
    }
    return kept_.front().file;
  }

 private:
  struct Kept {
    Stamp stamp;
    FieldFile file;
  };

  static FieldFile read(const fs::path& path, FlowQuantity quantity) {
    if (is_eclipse_name(path)) {
      FieldFile file{std::make_shared<const FlowField>(read_eclipse(path, quantity)), ""};
      std::string prints;
      for (const fs::path& one : files_of(path)) prints += fingerprint_of_file(one.string());
      file.fingerprint = fingerprint(prints);
      return file;
    }
    std::error_code error;
    if (fs::file_size(path, error) > kMostCopiedBytes && !error) {
      const MappedFile large(path.string());
      return of_table(large.text(), path, quantity);
    }
    return of_table(read_input_or_throw(path.string(), kMostCopiedBytes), path, quantity);
  }

  static FieldFile of_table(std::string_view text, const fs::path& path, FlowQuantity quantity) {
    return {std::make_shared<const FlowField>(parse_flow_csv(text, path.string(), quantity)),
            fingerprint(text)};
  }

  void forget() {
    std::size_t n_bytes = 0, n_kept = 0;
    for (const Kept& one : kept_) {
      n_bytes += bytes_of(*one.file.field);
      if (n_kept > 0 && n_bytes > kMostKeptBytes) break;
      ++n_kept;
    }
    kept_.resize(n_kept);
  }

  std::mutex mutex_;
  std::vector<Kept> kept_;
};

}  // namespace

FieldFile read_field_file(const fs::path& path, FlowQuantity quantity) {
  static KeptFiles files;
  return files.get(path, quantity);
}

}  // namespace faultsim
