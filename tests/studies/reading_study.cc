// What reading and planning a scene costs: milliseconds of the fastest of many times. Arguments:
// SCENES.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

#include "simulator/simulation/simulation.h"

int main(int n_arguments, char** arguments) {
  for (int i = 1; i < n_arguments; ++i) {
    std::stringstream text;
    text << std::ifstream(arguments[i]).rdbuf();
    double least = 1e9;
    for (int k = 0; k < 500; ++k) {
      const auto start = std::chrono::steady_clock::now();
      const auto simulation = faultsim::Simulation::from_text(text.str(), arguments[i]);
      const std::chrono::duration<double, std::milli> spent =
          std::chrono::steady_clock::now() - start;
      least = std::min(least, spent.count());
    }
    std::printf("%s %.4f\n", arguments[i], least);
  }
}
