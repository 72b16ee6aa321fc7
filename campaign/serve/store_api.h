#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "campaign/serve/open_stores.h"
#include "campaign/serve/request.h"
#include "campaign/serve/sliders.h"
#include "campaign/serve/what_if_desk.h"

namespace faultsweep {

namespace serve {
class Asked;
}

/// What a store says over HTTP, without sockets: the answers of the commands as the JSON that they
/// print with --json, and drawings as SVG. Each request sees the store as it is then, so what a
/// running campaign has added since is seen. Used from several threads at once.
class StoreApi {
 public:
  /// @param store  a folder with a store.
  /// @param simulator  the faultsim binary, for what-if; empty = without.
  explicit StoreApi(const std::filesystem::path& store, const std::filesystem::path& simulator = {},
                    int build_threads = 1);

  /// Never throws: what is wrong is a response, in JSON with place, cause and cure. No response has
  /// the store's folder, the working one or the user's home in it: they read STORE, "." and "~";
  /// nor that of its simulator or of the operators kept for it.
  HttpResponse answer(const HttpRequest& request);
  /// Throws StorageError when the store is not there any more.
  void require_store() const;
  /// Requests that wait for a simulator are answered as it stands.
  void close();

 private:
  HttpResponse answer_or_throw(const HttpRequest& request);
  HttpResponse answer_with_paths(const HttpRequest& request);
  HttpResponse answer_what_if(const HttpRequest& request);
  /// A case that what-if is asked of, and what a page may change of it. Cases do not change, so it
  /// is read once for all questions about it.
  struct SlidCase {
    serve::OpenStores::FileId file = {};
    std::vector<std::string> path;  ///< of the request.
    std::string scene, source;
    std::vector<serve::Slider> sliders;
  };
  std::shared_ptr<const SlidCase> slid_case(const HttpRequest& request, const serve::Asked& asked);

  std::filesystem::path store_;
  serve::OpenStores stores_;
  std::vector<std::pair<std::string, std::string>> shown_;  ///< path -> what stands for it.
  std::unique_ptr<serve::WhatIfDesk> desk_;
  std::mutex mutex_;
  std::shared_ptr<const SlidCase> slid_;  ///< of the newest question.
};

}  // namespace faultsweep
