#include "campaign/serve/what_if_desk.h"

#include <utility>

#include "campaign/common/names.h"

namespace faultsweep::serve {
namespace {

using std::chrono::milliseconds;

/// Between two looks at a question that may have been superseded.
constexpr int kBeatMs = 2;

/// More would leave nobody to answer other requests (ServerLimits::threads); they are told at once
/// how far it is.
constexpr int kMostWaiting = 2;

/// The number and the state of a reply; its drawings, which are most of it, are the page's.
json head_of(const std::string& reply) {
  const auto is_of_head = [](int depth, json::parse_event_t event, const json& value) {
    return depth != 1 || event != json::parse_event_t::key || value == "ask" || value == "state";
  };
  return json::parse(reply, is_of_head, false);
}

std::string state_text(const char* state, const std::string& says = {}) {
  ordered_json reply = {{"state", state}};
  if (!says.empty()) reply["says"] = says;
  return reply.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

WhatIfDesk::WhatIfDesk(Settings settings)
    : settings_(std::move(settings)), thread_([this] { live(); }) {}

void WhatIfDesk::close() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
}

WhatIfDesk::~WhatIfDesk() {
  close();
  thread_.join();
}

std::string WhatIfDesk::ask(const WhatIfQuestion& question, milliseconds longest) {
  std::unique_lock lock(mutex_);
  const bool is_old = question.page == page_ && question.number < number_;
  if (is_old) return state_text("superseded");
  if (!is_at(question)) {
    if (question.scene != scene_) {
      scene_ = question.scene;
      outgoing_.push_back(
          json{{"scene", json::parse(question.scene)}, {"source", question.source}}.dump());
    }
    json body = question.body;
    body["ask"] = ++asked_;
    outgoing_.push_back(body.dump());
    page_ = question.page;
    number_ = question.number;
    is_open_ = true;
    reply_ = state_text("running");
    changed_.notify_all();
  }
  if (n_waiting_ >= kMostWaiting) return told(question);
  ++n_waiting_;
  changed_.wait_for(lock, longest, [&] { return !is_at(question) || !is_open_ || is_ending_; });
  --n_waiting_;
  return told(question);
}

std::string WhatIfDesk::told(const WhatIfQuestion& question) const {
  if (is_at(question)) return reply_;
  const bool is_ours = question.page == page_;
  return state_text("superseded", is_ours ? "" : "another page has asked this server since");
}

/// Answers questions until the end; the simulator lives in between, for a while.
void WhatIfDesk::live() {
  const auto rest = std::chrono::duration<double>(settings_.rest_seconds);
  while (true) {
    {
      std::unique_lock lock(mutex_);
      const bool woken = changed_.wait_for(
          lock, rest, [&] { return is_ending_ || is_open_ || !outgoing_.empty(); });
      if (is_ending_) break;
      if (!woken) {
        process_.reset();
        scene_.clear();
        continue;
      }
    }
    try {
      if (process_ == nullptr) start();
      exchange();
    } catch (const faultsim::Error& error) {
      fail(error.what());
    }
  }
  process_.reset();
}

void WhatIfDesk::start() {
  SimulatorProcess::Options options;
  options.binary = settings_.simulator;
  options.command = "what-if";
  options.cache = cache_.path();
  options.threads = settings_.threads;
  process_ = std::make_unique<SimulatorProcess>(options);
}

/// Operators of the store that are new since, as if they were in the simulator's own cache.
void WhatIfDesk::link_operators() {
  std::error_code error;  // what cannot be looked at is built anew
  for (const auto& entry : std::filesystem::directory_iterator(settings_.operators, error)) {
    if (entry.path().extension() != ".h5") continue;
    std::filesystem::create_symlink(std::filesystem::absolute(entry.path()),
                                    cache_.path() / entry.path().filename(), error);
  }
}

void WhatIfDesk::exchange() {
  std::deque<std::string> lines;
  {
    const std::lock_guard lock(mutex_);
    std::swap(lines, outgoing_);
  }
  for (const std::string& line : lines) {
    if (line.starts_with("{\"scene\"")) link_operators();
    process_->send(line);
  }
  process_->exchange(kBeatMs);
  while (const auto reply = process_->next_reply()) take(*reply);
  if (!process_->is_silent()) return;
  const ProcessEnd end = process_->wait(1);
  const std::string said = process_->log_tail();
  fail(concat("the simulator ", describe(end), said.empty() ? "" : ": ", said));
}

void WhatIfDesk::take(const std::string& reply) {
  const json head = head_of(reply);
  if (!head.is_object() || !head.contains("ask")) return;  // its greeting
  const std::lock_guard lock(mutex_);
  if (head.at("ask") != asked_) return;
  reply_ = reply;
  const std::string state = head.value("state", "");
  is_open_ = state == "building" || state == "running";
  if (!is_open_) changed_.notify_all();
}

/// The next question is for a simulator of its own.
void WhatIfDesk::fail(const std::string& why) {
  process_.reset();
  const std::lock_guard lock(mutex_);
  outgoing_.clear();
  scene_.clear();
  if (is_open_) reply_ = state_text("failed", why);
  is_open_ = false;
  changed_.notify_all();
}

}  // namespace faultsweep::serve
