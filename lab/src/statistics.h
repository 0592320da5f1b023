#pragma once

#include <vector>

#include "base/averages.h"
#include "hires/base/rng.h"

namespace hires::lab {

using base::Mean;
double Deviation(const std::vector<double>& values);  ///< divides by n, as the dissertation does

/// An estimate with its 95 % interval.
struct Interval {
  double estimate{0.0};
  double lower{0.0};
  double upper{0.0};
  bool ExcludesZero() const { return lower > 0.0 || upper < 0.0; }
};

/// Mean of paired differences with Student's t interval: n - 1 degrees of freedom, sample
/// deviation. Without differences everything is 0; a single one has an unbounded interval.
Interval MeanInterval(const std::vector<double>& differences);

/// Mean with the 2.5 % and 97.5 % percentiles of the means of 10 000 resamples [Efron 1979, Ann.
/// Stat. 7:1-26]: never beyond the values. Without values everything is 0.
Interval BootstrapInterval(const std::vector<double>& values, base::Rng rng);

/// An estimate with the 2.5 % and 97.5 % percentiles of what it is in each resample. Resamples in
/// which it is no number (0 / 0) are left out; where that leaves none, both ends are no numbers.
Interval PercentileInterval(double estimate, std::vector<double> resampled);

/// Exact interval of a share [Clopper, Pearson 1934, Biometrika 26:404-413].
/// @pre 0 <= num_hits <= num_all.  @throws std::logic_error if broken. (0 of 0 gives 0 .. 1.)
Interval ShareInterval(int num_hits, int num_all);

/// Score interval of a share [Wilson 1927, J. Am. Stat. Assoc. 22:209-212]: shorter than the exact
/// one, and right on average.
/// @pre 0 <= num_hits <= num_all.  @throws std::logic_error if broken. (0 of 0 gives 0 .. 1.)
Interval WilsonInterval(int num_hits, int num_all);

/// What was counted together, for example the things on one table.
struct ClusterCounts {
  int num_hits{0};
  int num_all{0};
};

ClusterCounts SumOf(const std::vector<ClusterCounts>& clusters);

/// Share of hits among all that is in the clusters, where what is in one cluster may go alike: as
/// ShareInterval for as many independent cases as say the same, found by the variance of the ratio
/// between clusters and Student's t of their number [Korn, Graubard 1998, Surv. Methodol.
/// 24:193-201]. That variance is too small more often than not where few clusters have a miss (or a
/// hit, where these are rarer); so it counts as if one more of these had gone alike altogether, and
/// where there are none, all are taken to go alike. Clusters of one case each give ShareInterval;
/// empty ones do not count. Without cases: 0 (0 .. 1).
/// @pre 0 <= num_hits <= num_all in each.  @throws std::logic_error if broken.
Interval ClusteredShareInterval(const std::vector<ClusterCounts>& clusters);

/// What happened to the two members of each pair.
struct PairedCounts {
  int only_first{0};   ///< it happened to the first member alone
  int only_second{0};  ///< ... to the second alone
  int num_pairs{0};    ///< all pairs, also those in which it happened to both or to none
};

/// Difference of two paired shares (first - second). Given the number of discordant pairs, the
/// share among them that speaks for the first member has an exact interval (ShareInterval), which
/// is carried over to the difference: it excludes 0 exactly when McNemar's exact test (two-sided,
/// doubled tail) rejects at 5 %. Where no pair is discordant, the difference is bounded by the
/// largest share of discordant pairs that n concordant ones allow (97.5 %).
/// @pre counts are not negative and fit into num_pairs.  @throws std::logic_error if broken.
Interval PairedShareDifference(const PairedCounts& counts);

/// Difference of two paired shares (first - second) with its 95 % score interval: all differences
/// that the score test does not reject, the nuisance share being at its restricted maximum of
/// likelihood [Tango 1998, Stat. Med. 17:891-908]. Holds its level well from about ten pairs on,
/// also when all pairs agree [Fagerland, Lydersen, Laake 2014, Stat. Med. 33:2850-2875]. Unlike
/// PairedShareDifference it does not take the share of discordant pairs as given.
/// Without pairs: 0 (-1 .. 1).
/// @pre counts are not negative and fit into num_pairs.  @throws std::logic_error if broken.
Interval PairedScoreInterval(const PairedCounts& counts);

/// P-value of McNemar's exact test: two-sided, doubled tail, at most 1; 1 without discordant pairs.
double McNemarPValue(const PairedCounts& counts);

/// P-value of the sign-flip test that the mean of paired differences is 0, two-sided: it asks how
/// often a mean at least as far from 0 comes when each difference keeps its size and takes either
/// sign [Fisher 1935, The Design of Experiments, section 21]. Needs no distribution, only that
/// differences are symmetric about 0 where there is no effect. All signs are tried for at most 16
/// differences that are not 0; else 20,000 draws, themselves counted [Phipson, Smyth 2010, Stat.
/// Appl. Genet. Mol. Biol. 9:39], so that the test keeps its level. 1 without differences.
double SignFlipPValue(const std::vector<double>& differences, base::Rng rng);

}  // namespace hires::lab
