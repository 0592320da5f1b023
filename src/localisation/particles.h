#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/pose.h"
#include "localisation/beams.h"
#include "localisation/likelihood_field.h"

namespace hires::localisation {

/// Poses X_MB with weights that sum up to 1; a column for each quantity, as what is done with them
/// is done column by column.
struct Particles {
  std::vector<double> x, y, yaw, weight;

  std::size_t size() const { return x.size(); }
  void Add(const geometry::Pose2& X_MB, double weight_);
  geometry::Pose2 pose(std::size_t i) const { return {x[i], y[i], yaw[i]}; }
};

/// 1 / sum of the squared weights: how many particles of equal weight say as much.
double EffectiveSize(const Particles& particles);

/// For each particle the sum over the beams of `table` at the obstacle nearest to the beam's end.
void SumOverBeams(const Particles& particles, const Beams& beams, const LikelihoodField& field,
                  const std::vector<float>& table, std::vector<float>* sums);

/// Bins of 0.5 m x 0.5 m x 10 degrees, as AMCL counts them.
struct Bins {
  std::vector<std::int64_t> keys;  ///< of the bins that have particles, rising
  std::vector<int> bin_of;         ///< each particle's, an index of `keys`
};
Bins BinsOf(const Particles& particles);

/// Groups of bins that touch, by side, edge or corner: for each particle the number of its group,
/// by falling weight.
struct Clusters {
  std::vector<int> cluster_of;  ///< each particle's
  std::vector<double> weights;  ///< of the clusters, falling
};
Clusters ClustersOf(const Particles& particles);

/// How many particles keep the error of the belief below `error`, with the standard normal
/// quantile `z`, if they fill `num_bins` [Fox 2003, IJRR 22:985-1003]; at most `most`.
int KldSize(int num_bins, double error, double z, int most);

struct KldParams {
  double error{0.05}, z{0.99};
  int least{500}, most{5000};
};

/// Draws particles of equal weight by one random number [Carpenter, Clifford, Fearnhead 1999, IEE
/// Proc. 146:2-7], as many as the bins demand that they fill.
Particles Resample(const Particles& particles, const KldParams& params, base::Rng* rng);

}  // namespace hires::localisation
