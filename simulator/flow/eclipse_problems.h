#pragma once

#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "simulator/common/errors.h"

namespace faultsim {

/// What is wrong with the files of a result, for one message; base of their readers.
class EclipseProblems {
 protected:
  void refuse(const std::filesystem::path& file, const std::string& what, const std::string& cure) {
    problems_.push_back({"", 0, file.filename().string() + ": " + what, cure});
  }

  /// Does the work; what the library throws meanwhile is about the file. Errors of ours go on.
  template <typename Work>
  void guarded(const std::filesystem::path& file, const Work& work) {
    try {
      work();
    } catch (const Error&) {
      throw;
    } catch (const std::exception& error) {
      refuse(file, std::string("cannot be read: ") + error.what(),
             "copy it again; it may be cut off");
    }
  }

  /// @param source  what the message is about.
  void throw_if_any(const std::filesystem::path& source) const {
    if (!problems_.empty()) throw InputError(source.string(), problems_);
  }

  std::vector<Problem> problems_;
};

}  // namespace faultsim
