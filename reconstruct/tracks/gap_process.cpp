// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tracks/gap_process.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "core/transform.h"
#include "reconstruct/clusters/cluster_frame.h"

namespace marey::reconstruct {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kCarriers = 6;        // Companions that define the frame.
constexpr std::size_t kMaxCompanions = 40;  // Companions in the posture's features.
constexpr std::size_t kMinCarriers = 3;
constexpr double kPresentShare = 0.9;
constexpr std::size_t kLessonFrames = 150;
// Share of the frames in which the marker is seen that are candidates for training: those
// with most companions, spread over the trial. Companions missing there have been
// bridged.
constexpr double kLessonShare = 0.6;
constexpr std::size_t kMinLessons = 20;
// Training frames next to the gap: the first two frames, then every 0.03 s.
constexpr double kEdge_s = 0.24;
constexpr double kEdgeStep_s = 0.03;
// Weight of a companion by the variation of its distance to the marker.
constexpr double kSteadyWeight_m = 0.0005;
constexpr double kSteadyReach_m = 0.0015;

/// The covariance, as shares of the marker's variance within its frame. Determined on
/// captured walking and fighting; errors change by less than a tenth if any of them is
/// doubled or halved.
struct Kernel {
  std::size_t companions;
  double similar_reach;  ///< Length scale of features, in their own spread.
};
constexpr std::array kKernels{Kernel{8, 0.7}, Kernel{kMaxCompanions, 0.5}};
constexpr double kLinear = 3.0;
constexpr double kSimilar = 0.3;
constexpr double kTime = 0.1;
constexpr double kTimeReach_s = 0.15;
constexpr double kMisfit = 3e-3;
constexpr double kMisfitReach_s = 0.2;  // Time constant of misfits, which are known at
                                        // the gap's edges.
constexpr double kMarkerNoise_m = 0.0003;
// Correction of the processes' sigmas, which are slightly too small.
constexpr double kSigmaFactor = 1.15;
// A cluster is rigid if its marker moves by less in its frame.
constexpr double kRigid_m = 0.004;

bool is_seen(const GapContext& trial, std::size_t frame, std::size_t marker) {
  return trial.tracks.at(frame, marker).has_value();
}

/// Returns the marker's companions, steadiest first, that are seen in most of the piece.
std::vector<std::size_t> present_companions(const GapContext& trial,
                                            std::size_t marker,
                                            const FrameSpan& piece) {
  std::vector<std::size_t> present;
  for (const std::size_t other : trial.distances.companions(marker)) {
    std::size_t seen = 0;
    for (std::size_t f = piece.first; f < piece.end; ++f) {
      seen += is_seen(trial, f, other) ? 1 : 0;
    }
    if (static_cast<double>(seen) < kPresentShare * static_cast<double>(piece.size())) {
      continue;
    }
    present.push_back(other);
    if (present.size() == kMaxCompanions) break;
  }
  return present;
}

/// Chooses training frames: the marker is seen in them, with as many companions as
/// possible. Evenly chosen, and denser near the gap.
std::vector<std::size_t> choose_lessons(const GapContext& trial,
                                        std::size_t marker,
                                        const FrameSpan& gap,
                                        std::span<const std::size_t> companions) {
  const std::size_t frames = trial.tracks.frames();
  std::vector<std::size_t> missing(frames, companions.size() + 1);
  std::vector<std::size_t> with_missing(companions.size() + 2, 0);
  for (std::size_t f = 0; f < frames; ++f) {
    if (is_seen(trial, f, marker)) {
      missing[f] = 0;
      for (const std::size_t c : companions) missing[f] += is_seen(trial, f, c) ? 0 : 1;
    }
    ++with_missing[missing[f]];
  }
  std::size_t maximum = 0;
  std::size_t found = with_missing[0];
  const double wanted = kLessonShare * static_cast<double>(frames - with_missing.back());
  while (static_cast<double>(found) < wanted && maximum < companions.size())
    found += with_missing[++maximum];
  std::vector<std::size_t> fit;
  for (std::size_t f = 0; f < frames; ++f) {
    if (missing[f] <= maximum) fit.push_back(f);
  }
  std::vector<std::size_t> lessons;
  const std::size_t count = std::min(kLessonFrames, fit.size());
  for (std::size_t i = 0; i < count; ++i) {
    lessons.push_back(fit[count == 1 ? 0 : i * (fit.size() - 1) / (count - 1)]);
  }
  const double hz = trial.tracks.rate.hz;
  const auto reach = static_cast<std::size_t>(std::lround(kEdge_s * hz));
  const auto step = std::max<std::size_t>(1, std::lround(kEdgeStep_s * hz));
  for (std::size_t i = 0; i < std::max<std::size_t>(reach, 2); ++i) {
    if (i > 1 && i % step != 0) continue;
    if (gap.first > i) lessons.push_back(gap.first - 1 - i);
    if (gap.end + i < frames) lessons.push_back(gap.end + i);
  }
  std::erase_if(lessons, [&](std::size_t f) { return !is_seen(trial, f, marker); });
  std::sort(lessons.begin(), lessons.end());
  lessons.erase(std::unique(lessons.begin(), lessons.end()), lessons.end());
  return lessons;
}

/// Frames relative to the cluster.
struct InCluster {
  std::vector<RigidTransform> world_from_cluster;
  MatrixXd marker;    ///< Per frame: the marker's place. [m]
  MatrixXd features;  ///< Per frame: the companions' places, weighted.
};

struct Cluster {
  std::vector<std::size_t> companions;  ///< The first kCarriers carry it.
  std::vector<double> carrier_weights;
  std::vector<double> feature_weights;
  std::vector<glm::dvec3> shape;  ///< Shape of the carriers.
};

std::vector<glm::dvec3> carriers_in_world(const GapContext& trial,
                                          const Cluster& cluster,
                                          std::size_t frame) {
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i < cluster.carrier_weights.size(); ++i) {
    points.push_back(
        trial.p_in_world[frame * trial.tracks.markers() + cluster.companions[i]]);
  }
  return points;
}

Cluster make_cluster(const GapContext& trial,
                     std::size_t marker,
                     std::vector<std::size_t> companions,
                     std::span<const std::size_t> lessons) {
  Cluster cluster;
  cluster.companions = std::move(companions);
  for (std::size_t i = 0; i < cluster.companions.size(); ++i) {
    const double variance_m2 =
        trial.distances.between(marker, cluster.companions[i]).variance_m2;
    if (i < kCarriers) {
      cluster.carrier_weights.push_back(
          1.0 / (variance_m2 + kSteadyWeight_m * kSteadyWeight_m));
    }
    cluster.feature_weights.push_back(kSteadyReach_m /
                                      (std::sqrt(variance_m2) + kSteadyReach_m));
  }
  std::vector<glm::dvec3> shapes;
  for (const std::size_t f : lessons) {
    const auto points = carriers_in_world(trial, cluster, f);
    shapes.insert(shapes.end(), points.begin(), points.end());
  }
  cluster.shape = mean_shape(shapes, cluster.carrier_weights);
  return cluster;
}

template <class Frames>
InCluster look_from(const GapContext& trial,
                    std::size_t marker,
                    const Cluster& cluster,
                    const Frames& frames) {
  const std::size_t n = cluster.companions.size();
  InCluster seen;
  seen.marker.resize(static_cast<Index>(frames.size()), 3);
  seen.features.resize(static_cast<Index>(frames.size()), static_cast<Index>(3 * n));
  Index row = 0;
  for (const std::size_t f : frames) {
    const auto points = carriers_in_world(trial, cluster, f);
    const RigidTransform cluster_from_world =
        align(points, cluster.shape, cluster.carrier_weights);
    const auto* in_world = &trial.p_in_world[f * trial.tracks.markers()];
    const glm::dvec3 p = cluster_from_world * in_world[marker];
    seen.marker.row(row) << p.x, p.y, p.z;
    for (std::size_t i = 0; i < n; ++i) {
      const glm::dvec3 c = cluster.feature_weights[i] *
                           (cluster_from_world * in_world[cluster.companions[i]]);
      seen.features.row(row).segment<3>(static_cast<Index>(3 * i)) << c.x, c.y, c.z;
    }
    seen.world_from_cluster.push_back(inverse(cluster_from_world));
    ++row;
  }
  return seen;
}

struct Prediction {
  MatrixXd mean;      ///< Per frame, minus the training mean. [m]
  VectorXd variance;  ///< Per coordinate. [m^2]
};

/// Covariances between two sets of frames; times are in frames.
MatrixXd covariance(const MatrixXd& a,
                    const MatrixXd& b,
                    const VectorXd& time_a_s,
                    const VectorXd& time_b_s,
                    double reach) {
  MatrixXd k = a * b.transpose();
  const VectorXd a2 = a.rowwise().squaredNorm();
  const VectorXd b2 = b.rowwise().squaredNorm();
  for (Index j = 0; j < k.cols(); ++j) {
    for (Index i = 0; i < k.rows(); ++i) {
      const double linear = k(i, j);
      const double apart2 = std::max(0.0, a2[i] + b2[j] - 2.0 * linear);
      const double u = std::abs(time_a_s[i] - time_b_s[j]) / kTimeReach_s;
      k(i, j) = kLinear * linear + kSimilar * std::exp(-apart2 / (2.0 * reach * reach)) +
                kTime * (1.0 + u) * std::exp(-u);
    }
  }
  return k;
}

struct Lessons {
  MatrixXd features;
  MatrixXd marker;  ///< Minus its mean.
  VectorXd time_s;
  VectorXd noise;  ///< As a share of `variance_m2`.
  double variance_m2 = 0.0;
};

/// Computes the posterior of one process (Rasmussen & Williams 2006, eq. 2.25 and 2.26),
/// its scale by maximum likelihood.
std::optional<Prediction> predict(const Lessons& lessons,
                                  const MatrixXd& wanted_features,
                                  const VectorXd& wanted_s,
                                  const Kernel& kernel) {
  const Index width =
      std::min<Index>(lessons.features.cols(), static_cast<Index>(3 * kernel.companions));
  MatrixXd taught = lessons.features.leftCols(width);
  MatrixXd wanted = wanted_features.leftCols(width);
  const double spread = std::sqrt(taught.rowwise().squaredNorm().mean()) + 1e-9;
  taught /= spread;
  wanted /= spread;
  MatrixXd k =
      covariance(taught, taught, lessons.time_s, lessons.time_s, kernel.similar_reach);
  k.diagonal() += lessons.noise;
  const Eigen::LLT<MatrixXd> llt(k);
  if (llt.info() != Eigen::Success) return std::nullopt;
  const MatrixXd cross =
      covariance(taught, wanted, lessons.time_s, wanted_s, kernel.similar_reach);
  const MatrixXd half = llt.matrixL().solve(lessons.marker);
  const MatrixXd reach = llt.matrixL().solve(cross);
  Prediction found;
  found.mean = reach.transpose() * half;
  const double scale_m2 = half.squaredNorm() / static_cast<double>(half.size());
  const VectorXd prior =
      (kLinear * wanted.rowwise().squaredNorm().array() + kSimilar + kTime).matrix();
  found.variance =
      scale_m2 * (prior - reach.colwise().squaredNorm().transpose()).cwiseMax(0.0);
  return found;
}

}  // namespace

std::optional<GapFill> fill_gap(const GapContext& trial,
                                std::size_t marker,
                                const FrameSpan& gap,
                                const FrameSpan& piece) {
  std::vector<std::size_t> companions = present_companions(trial, marker, piece);
  if (companions.size() < kMinCarriers) return std::nullopt;
  const std::vector<std::size_t> frames = choose_lessons(trial, marker, gap, companions);
  if (frames.size() < kMinLessons) return std::nullopt;
  const Cluster cluster = make_cluster(trial, marker, std::move(companions), frames);
  std::vector<std::size_t> wanted_frames;
  for (std::size_t f = piece.first; f < piece.end; ++f) wanted_frames.push_back(f);
  InCluster taught = look_from(trial, marker, cluster, frames);
  InCluster wanted = look_from(trial, marker, cluster, wanted_frames);

  const double hz = trial.tracks.rate.hz;
  Lessons lessons;
  const Eigen::RowVectorXd feature_mean = taught.features.colwise().mean();
  const Eigen::RowVector3d marker_mean = taught.marker.colwise().mean();
  lessons.features = taught.features.rowwise() - feature_mean;
  lessons.marker = taught.marker.rowwise() - marker_mean;
  wanted.features.rowwise() -= feature_mean;
  const auto count = static_cast<Index>(frames.size());
  lessons.variance_m2 =
      lessons.marker.squaredNorm() / static_cast<double>(3 * count) + 1e-12;
  lessons.time_s.resize(count);
  lessons.noise.resize(count);
  for (Index i = 0; i < count; ++i) {
    const auto f = frames[static_cast<std::size_t>(i)];
    lessons.time_s[i] = static_cast<double>(f) / hz;
    const std::size_t away = f < gap.first ? gap.first - f : f + 1 - gap.end;
    lessons.noise[i] =
        kMarkerNoise_m * kMarkerNoise_m / lessons.variance_m2 +
        kMisfit * std::min(1.0, static_cast<double>(away) / hz / kMisfitReach_s);
  }
  VectorXd wanted_s(static_cast<Index>(piece.size()));
  for (Index i = 0; i < wanted_s.size(); ++i) {
    wanted_s[i] = static_cast<double>(piece.first + static_cast<std::size_t>(i)) / hz;
  }

  std::vector<Prediction> found;
  for (const Kernel& kernel : kKernels) {
    auto one = predict(lessons, wanted.features, wanted_s, kernel);
    if (one) found.push_back(std::move(*one));
    if (cluster.companions.size() <= kernel.companions) break;
  }
  if (found.empty()) return std::nullopt;

  GapFill fill;
  const std::size_t carriers = cluster.carrier_weights.size();
  fill.carried_by.assign(cluster.companions.begin(),
                         cluster.companions.begin() + static_cast<Index>(carriers));
  fill.method = std::sqrt(lessons.variance_m2) < kRigid_m ? RepairMethod::kCluster
                                                          : RepairMethod::kStructure;
  for (Index i = 0; i < wanted_s.size(); ++i) {
    Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
    for (const Prediction& one : found) mean += one.mean.row(i);
    mean /= static_cast<double>(found.size());
    double variance_m2 = 0.0;
    for (const Prediction& one : found) {
      variance_m2 += one.variance[i] + (one.mean.row(i) - mean).squaredNorm() / 3.0;
    }
    variance_m2 /= static_cast<double>(found.size());
    mean += marker_mean;
    const auto& world_from_cluster =
        wanted.world_from_cluster[static_cast<std::size_t>(i)];
    fill.p_in_world.push_back(world_from_cluster * glm::dvec3(mean[0], mean[1], mean[2]));
    fill.sigma_m.push_back(kSigmaFactor *
                           std::sqrt(variance_m2 + kMarkerNoise_m * kMarkerNoise_m));
  }
  return fill;
}

}  // namespace marey::reconstruct
