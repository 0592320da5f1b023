// Slow or fast? Imagines it in this process, and prints the ranking.
//
//     own_program_imagine FOLDER    where config/ and worlds/ of HIRES lie
#include <hires/imagination/imagination.h>

#include <cstdlib>
#include <iostream>

namespace imagination = hires::imagination;

imagination::Report AskHowToDrive(const std::string& folder) {
  const imagination::ClientConfig config =
      imagination::ReadClientConfig(folder + "/config/imagination_client.yaml");
  imagination::SetupConfig files = imagination::ReadSetupConfig(config.scene);
  files.world = folder + "/worlds/workshop.world";
  const imagination::ImaginationSetup setup = imagination::LoadImaginationSetup(files);
  const imagination::StartState start = imagination::MakeStartState(setup, "dock", {"peppermill1"});
  imagination::SchedulerParams params = config.scheduler;
  params.rollouts = 16;
  return imagination::ImagineLocally(
      imagination::MakeRolloutSetup(setup, start, 7),
      hires::base::Combinations({"move_base_param", {{"atBench"}, {"slow", "fast"}}}), params, 2);
}

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: own_program_imagine FOLDER\n";
    return EXIT_FAILURE;
  }
  try {
    const imagination::Report report = AskHowToDrive(argv[1]);
    for (const imagination::Prediction& way : report.ranking) {
      std::cout << ToString(way.action) << ' ' << way.evidence.success.share << ' '
                << way.evidence.duration.mean << " s\n";
    }
    std::cout << report.why << '\n';
  } catch (const hires::base::ConfigError& error) {
    std::cerr << "own_program_imagine: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
