#include "campaign/serve/open_stores.h"

#include <sys/stat.h>

#include <exception>

namespace faultsweep::serve {

OpenStores::Lease::Lease(OpenStores& owner, std::unique_ptr<Store> store)
    : owner_(owner), store_(std::move(store)), exceptions_(std::uncaught_exceptions()) {
  store_->hold_state();
}

OpenStores::Lease::~Lease() {
  if (std::uncaught_exceptions() > exceptions_) return;
  try {
    store_->let_state_go();
    const std::lock_guard lock(owner_.mutex_);
    if (store_->sees_changes() && owner_.file_id() == owner_.opened_)
      owner_.free_.push_back(std::move(store_));
  } catch (const std::exception&) {
    store_.reset();  // the next request opens another and says what is wrong
  }
}

OpenStores::FileId OpenStores::file_id() const {
  struct stat info = {};
  return stat((folder_ / "campaign.sqlite").c_str(), &info) == 0 ? FileId(info.st_dev, info.st_ino)
                                                                 : FileId();
}

OpenStores::Lease OpenStores::take() {
  std::unique_ptr<Store> store;
  {
    const std::lock_guard lock(mutex_);
    const FileId now = file_id();
    if (now != opened_) free_.clear();
    opened_ = now;
    if (!free_.empty()) {
      store = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (!store) store = std::make_unique<Store>(Store::open_reader(folder_));
  return {*this, std::move(store)};
}

}  // namespace faultsweep::serve
