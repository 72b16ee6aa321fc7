#include "simulator/coupled/held_responses.h"

#include <gtest/gtest.h>

#include <vector>

namespace faultsim {
namespace {

/// u = A load, t' = B load.
struct LinearBody {
  Eigen::MatrixXd a = Eigen::MatrixXd::Random(6, 6), b = Eigen::MatrixXd::Random(2, 6);
  HeldResponses::Response response(const Eigen::VectorXd& load) const {
    return {load, a * load, b * load};
  }
};

Eigen::VectorXd combined(const std::vector<Eigen::VectorXd>& loads, const Eigen::VectorXd& shares) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(loads.front().size());
  for (std::size_t k = 0; k < loads.size(); ++k) sum += shares[static_cast<int>(k)] * loads[k];
  return sum;
}

TEST(HeldResponses, KnowEveryCombinationOfTheLoadsThatTheyHaveSeen) {
  const Ranks alone;
  HeldResponses held(alone);
  const LinearBody body;
  const std::vector<Eigen::VectorXd> loads = {
      Eigen::VectorXd::Random(6), Eigen::VectorXd::Random(6), Eigen::VectorXd::Random(6)};
  for (const Eigen::VectorXd& load : loads) held.keep(body.response(load));
  const Eigen::VectorXd load = combined(loads, Eigen::Vector3d(2, -0.3, 5));
  Eigen::VectorXd u = Eigen::VectorXd::Ones(6), traction = Eigen::VectorXd::Ones(2);
  held.add_nearest(load, u, traction);
  EXPECT_LT((u - Eigen::VectorXd::Ones(6) - body.a * load).norm(), 1e-12 * u.norm());
  EXPECT_LT((traction - Eigen::VectorXd::Ones(2) - body.b * load).norm(), 1e-12 * u.norm());
}

TEST(HeldResponses, LeaveWhatTheyDoNotKnow) {
  const Ranks alone;
  HeldResponses held(alone);
  const LinearBody body;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(6), traction = Eigen::VectorXd::Zero(2);
  held.add_nearest(Eigen::VectorXd::Unit(6, 1), u, traction);
  EXPECT_EQ(u, Eigen::VectorXd::Zero(6)) << "nothing is known at first";
  held.keep(body.response(Eigen::VectorXd::Unit(6, 0)));
  held.add_nearest(Eigen::VectorXd::Unit(6, 1), u, traction);
  EXPECT_EQ(u, Eigen::VectorXd::Zero(6)) << "across the load that is known";
}

TEST(HeldResponses, DoNotTakeErrorsForWhatIsNew) {
  const Ranks alone;
  HeldResponses held(alone);
  const LinearBody body;
  const Eigen::VectorXd load = Eigen::VectorXd::Unit(6, 2);
  held.keep(body.response(load));
  HeldResponses::Response nearly = body.response(load);
  nearly.load += 1e-6 * Eigen::VectorXd::Unit(6, 3);
  nearly.u += 1e-5 * Eigen::VectorXd::Unit(6, 4);
  held.keep(nearly);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(6), traction = Eigen::VectorXd::Zero(2);
  held.add_nearest(Eigen::VectorXd::Unit(6, 3), u, traction);
  EXPECT_EQ(u, Eigen::VectorXd::Zero(6));
}

}  // namespace
}  // namespace faultsim
