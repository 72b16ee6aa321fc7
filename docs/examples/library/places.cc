// Where is a fault, and how close to sliding is it down a line through its middle?
#include <faultsim/simulation.h>

#include <cstdio>

int main(int argc, char** argv) try {
  auto field =
      faultsim::Simulation::from_file(argc > 1 ? argv[1] : "field.json", {{"/tier", "screening"}});
  faultsim::FaultFields last;
  faultsim::RunWatch watch;
  watch.step = [&](const faultsim::StepResult&, const faultsim::FaultFields& now) { last = now; };
  field.run({}, watch);

  const auto geometry = field.geometry();
  for (const faultsim::OperatorFault& fault : geometry->faults) {
    double area = 0;
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k)
      area += geometry->nodes[static_cast<std::size_t>(k)].area;
    std::printf("%s: %zu points, %zu faces, %d nodes on %.0f m%s, %zu profiles\n",
                fault.name.c_str(), fault.points.size(), fault.faces.size(), fault.n_nodes, area,
                geometry->plane_strain ? "" : "2", fault.profiles.size());
    const faultsim::Profile& middle = fault.profiles[fault.profiles.size() / 2];
    for (const faultsim::ProfileSample& sample : middle.samples) {
      const auto& node = geometry->nodes[static_cast<std::size_t>(sample.node[0])];
      std::printf("  %.0f m deep, %.0f m down dip: chi %.3f\n", -node.position.z(), sample.position,
                  sample.of(last.critical_index));
    }
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
