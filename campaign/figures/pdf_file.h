#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace faultsweep {

/// A page printed as PDF by a headless Chromium, where one is installed; without headers, footers
/// and the date of its making, so that the same page gives the same document. Nothing where there
/// is no such browser. Throws StorageError where it is there and makes none.
std::optional<std::string> pdf_of_page(const std::string& html);

/// Pages of such a document.
std::size_t count_pages(const std::string& pdf);

}  // namespace faultsweep
