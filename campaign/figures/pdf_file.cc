#include "campaign/figures/pdf_file.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "campaign/common/names.h"
#include "simulator/common/child_output.h"
#include "simulator/files/atomic_file.h"
#include "simulator/files/temporary_folder.h"

namespace faultsweep {

namespace {

constexpr int kNotFound = 127, kTimedOut = 124;  // of sh and timeout

std::string bytes_of(const std::filesystem::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

/// Prints page.html of the folder to page.pdf. Returns the exit code. The sandbox is off, as it is
/// not to be had for root and in containers; the page is ours, and its policy loads and runs
/// nothing.
int print_with(const char* browser, const std::filesystem::path& folder) {
  const faultsim::ChildOutput made = faultsim::run_child(
      {"/bin/sh", "-c", "exec timeout -k 5 120 \"$@\" >/dev/null 2>&1", "sh", browser, "--headless",
       "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
       "--disable-extensions", concat("--user-data-dir=", (folder / "profile").string()),
       "--no-pdf-header-footer", concat("--print-to-pdf=", (folder / "page.pdf").string()),
       "file://" + (folder / "page.html").string()});
  return made.start_error != 0 ? kNotFound : made.code;
}

/// Puts zeros in place of the digits of a date in the document's properties.
void blank_date(std::string& pdf, const char* key) {
  const std::string begin = concat("/", key, " (D:");
  for (std::size_t at = pdf.find(begin); at != std::string::npos; at = pdf.find(begin, at)) {
    at += begin.size();
    constexpr std::string_view kDate = "19700101000000";
    if (pdf.size() >= at + kDate.size()) pdf.replace(at, kDate.size(), kDate);
  }
}

}  // namespace

std::optional<std::string> pdf_of_page(const std::string& html) {
  const faultsim::TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path();
  faultsim::write_text(folder / "page.html", html);
  for (const char* browser : {"chromium", "chromium-browser", "google-chrome"}) {
    const int code = print_with(browser, folder);
    if (code == kNotFound) continue;
    std::string pdf = bytes_of(folder / "page.pdf");
    if (code == kTimedOut) throw StorageError(concat(browser, " made no PDF within two minutes"));
    if (code != 0 || !pdf.starts_with("%PDF"))
      throw StorageError(concat(browser, " made no PDF (exit code ", code, ")"));
    for (const char* key : {"CreationDate", "ModDate"}) blank_date(pdf, key);
    return pdf;
  }
  return std::nullopt;
}

std::size_t count_pages(const std::string& pdf) {
  constexpr std::string_view kPage = "/Type /Page";
  std::size_t n = 0;
  for (std::size_t at = pdf.find(kPage); at != std::string::npos; at = pdf.find(kPage, at)) {
    at += kPage.size();
    n += at < pdf.size() && pdf[at] != 's' ? 1 : 0;
  }
  return n;
}

}  // namespace faultsweep
