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
      refuse(file, "cannot be read: " + words_of(error), "copy it again; it may be cut off");
    }
  }

  /// @param source  what the message is about.
  void throw_if_any(const std::filesystem::path& source) const {
    if (problems_.empty()) return;
    const std::string own = source.filename().string() + ": ";
    std::vector<Problem> problems = problems_;
    for (Problem& one : problems)
      if (one.what.starts_with(own)) one.what.erase(0, own.size());
    throw InputError(source.string(), std::move(problems));
  }

  std::vector<Problem> problems_;

 private:
  /// "[./src/EclUtil.cpp:479] Tail not matching header.": the library's words without their place
  /// in its sources and the full stop.
  static std::string words_of(const std::exception& error) {
    std::string words = error.what();
    const std::size_t end_of_place = words.find("] ");
    if (words.starts_with('[') && end_of_place != std::string::npos)
      words.erase(0, end_of_place + 2);
    words.erase(words.find_last_not_of(". \n") + 1);
    return words;
  }
};

}  // namespace faultsim
