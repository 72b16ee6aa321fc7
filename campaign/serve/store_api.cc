#include "campaign/serve/store_api.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <new>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/expansion/expansion.h"
#include "campaign/serve/live_page.h"
#include "campaign/serve/route.h"
#include "campaign/store/store.h"
#include "simulator/files/json_text.h"

namespace faultsweep {
namespace {

using serve::Asked;
using serve::Route;

std::vector<std::string_view> parts_of(std::string_view path) {
  std::vector<std::string_view> parts;
  while (!path.empty()) {
    path.remove_prefix(1);  // the slash
    const std::size_t end = std::min(path.find('/'), path.size());
    parts.push_back(path.substr(0, end));
    path.remove_prefix(end);
  }
  return parts;
}

bool leads(const Route& route, const std::vector<std::string>& path) {
  return std::ranges::equal(parts_of(route.path), path,
                            [](std::string_view expected, const std::string& given) {
                              return expected.starts_with('{') || expected == given;
                            });
}

/// What can be asked for.
HttpResponse list_routes() {
  ordered_json routes = ordered_json::array();
  for (const Route* route : serve::all_routes()) {
    ordered_json parameters = ordered_json::object();
    for (const serve::Parameter& one : route->parameters) parameters[one.name] = one.meaning;
    routes.push_back({{"path", route->path},
                      {"meaning", route->meaning},
                      {"type", route->type},
                      {"parameters", parameters}});
  }
  return {200, "application/json", faultsim::json_text(ordered_json{{"routes", routes}})};
}

/// The first problem; its place is the parameter, which is called as the option is.
HttpProblem problem_of(const InputError& error) {
  const Problem& problem = error.problems().front();
  std::string place = error.source().starts_with("--") ? error.source().substr(2) : error.source();
  if (!problem.pointer.empty()) place += (place.empty() ? "" : ": ") + problem.pointer;
  return {400, place, problem.what, problem.cure};
}

constexpr int kUnavailable = 503, kBug = 500;

/// What cannot be read now is told on the terminal, where paths may stand.
HttpResponse unavailable(const char* cause, const std::string& remark) {
  HttpResponse response =
      error_response({kUnavailable, "store", cause, "see the terminal of faultsweep serve"});
  response.remark = remark;
  return response;
}

/// Where a path ends within a text: not in the middle of a longer name.
bool ends_a_path(const std::string& text, std::size_t end) {
  return end == text.size() ||
         std::string_view("/\"' \\;,:)<&").find(text[end]) != std::string::npos;
}

}  // namespace

StoreApi::StoreApi(const std::filesystem::path& store, const std::filesystem::path& simulator,
                   int build_threads)
    : store_(std::filesystem::absolute(store)), stores_(store_) {
  if (!simulator.empty())
    desk_ = std::make_unique<serve::WhatIfDesk>(
        serve::WhatIfDesk::Settings{simulator, store_ / "operators", build_threads});
  std::error_code error;  // a folder that is not there has only one name
  const auto show = [&](const std::filesystem::path& path, const char* as) {
    for (const std::filesystem::path& one :
         {path.lexically_normal(), std::filesystem::weakly_canonical(path, error)}) {
      std::string text = one.string();
      while (text.ends_with('/')) text.pop_back();
      if (!text.empty()) shown_.emplace_back(text, as);
    }
  };
  show(store_, "STORE");
  if (desk_ != nullptr) {  // which a simulator that fails may name
    show(desk_->cache(), "CACHE");
    show(std::filesystem::absolute(simulator), "faultsim");
  }
  show(std::filesystem::current_path(error), ".");
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') show(home, "~");
}

void StoreApi::require_store() const {
  std::error_code error;
  if (std::filesystem::exists(store_ / "campaign.sqlite", error)) return;
  throw StorageError(concat("the store ", store_.string(), " is gone; nothing is left to serve"));
}

void StoreApi::close() {
  if (desk_ != nullptr) desk_->close();
}

HttpResponse StoreApi::answer(const HttpRequest& request) {
  HttpResponse response = answer_with_paths(request);
  for (const auto& [path, as] : shown_) {
    for (std::size_t at = response.body.find(path); at != std::string::npos;
         at = response.body.find(path, at)) {
      if (ends_a_path(response.body, at + path.size())) response.body.replace(at, path.size(), as);
      at += 1;
    }
  }
  return response;
}

/// Errors become text here, as they do in run_program for a command: a request is one.
HttpResponse StoreApi::answer_with_paths(const HttpRequest& request) {
  try {
    return answer_or_throw(request);
  } catch (const HttpError& error) {
    return error_response(error.problem());
  } catch (const InputError& error) {
    return error_response(problem_of(error));
  } catch (const faultsim::Error& error) {
    return unavailable("the store cannot be read at present", error.what());
  } catch (const std::bad_alloc&) {
    return unavailable("there is not enough memory for the answer", "not enough memory");
  } catch (const std::exception& error) {
    HttpResponse response = error_response(
        {kBug, "server", "a bug of this program, or a damaged store",
         "check the store with `faultsweep status --verify`; if it is sound, report the bug"});
    response.remark = error.what();
    return response;
  }
}

HttpResponse StoreApi::answer_or_throw(const HttpRequest& request) {
  const std::vector<std::string>& path = request.path;
  if (path.empty()) return serve::live_page();
  if (path.size() == 1 && path[0] == "api") return list_routes();
  if (leads(serve::what_if_route(), path)) return answer_what_if(request);
  const std::vector<const Route*> routes = serve::all_routes();
  const auto found =
      std::ranges::find_if(routes, [&](const Route* route) { return leads(*route, path); });
  constexpr int kNotFound = 404;
  if (found == routes.end())
    throw HttpError(kNotFound, "path", "there is nothing at this path",
                    "GET /api lists what there is");
  const Asked asked(**found, request);
  const serve::OpenStores::Lease store = stores_.take();
  return (*found)->answer(*store, asked);
}

std::shared_ptr<const StoreApi::SlidCase> StoreApi::slid_case(const HttpRequest& request,
                                                              const Asked& asked) {
  const std::lock_guard lock(mutex_);
  const serve::OpenStores::FileId file = stores_.file_id();
  if (slid_ != nullptr && slid_->file == file && slid_->path == request.path) return slid_;
  const serve::OpenStores::Lease lease = stores_.take();
  const Store& store = *lease;
  const CampaignInfo campaign = asked.campaign(store);
  const StoredCase one = asked.stored_case(store, campaign);
  const BaseScene base = store.base_scene(one.scene);
  const json scene = scene_from_changes(base.document, one.changes);
  slid_ = std::make_shared<SlidCase>(
      SlidCase{file, request.path, scene.dump(), base.source,
               serve::sliders_of(scene, store.spec_copies(campaign.id).resolved)});
  return slid_;
}

HttpResponse StoreApi::answer_what_if(const HttpRequest& request) {
  const Asked asked(serve::what_if_route(), request);
  if (desk_ == nullptr)
    throw HttpError(kUnavailable, "what-if", "this server has no simulator",
                    "put faultsim beside faultsweep, or set FAULTSIM_BINARY");
  serve::WhatIfQuestion question;
  question.page = asked.text("page");
  question.number = asked.whole("ask", 1, std::numeric_limits<long>::max()).value_or(1);
  question.body = serve::question_body(asked);
  const auto slid = slid_case(request, asked);
  serve::require_allowed(slid->sliders, question.body.at("changes"));
  question.scene = slid->scene;
  question.source = slid->source;
  constexpr long kUsualWait = 1000, kLongestWait = 2000;  // ms
  const std::chrono::milliseconds wait(asked.whole("wait", 0, kLongestWait).value_or(kUsualWait));
  return {200, "application/json", desk_->ask(question, wait)};
}

}  // namespace faultsweep
