// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/place_by_tags.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "calib/model/consensus.h"
#include "calib/model/planar_pose.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

/// A tag of a target at one instant.
using Place = std::tuple<std::size_t, int, std::size_t>;  // target, instant, piece

struct SeenPose {
  const Sighting* sighting = nullptr;
  std::vector<RigidTransform> camera_from_piece;  ///< In metric scale.
};

std::array<glm::dvec2, 4> pixels_of(const Sighting& sighting) {
  std::array<glm::dvec2, 4> pixels{};
  for (std::size_t i = 0; i < 4; ++i) pixels[i] = sighting.corners[i].pixel_px;
  return pixels;
}

std::array<glm::dvec3, 4> corners_of(double size_m) {
  std::array<glm::dvec3, 4> corners{};
  for (int i = 0; i < 4; ++i) {
    corners[static_cast<std::size_t>(i)] = corner_in_tag(i, size_m);
  }
  return corners;
}

class TagPlacer {
 public:
  explicit TagPlacer(RigModel& model) : model_(model), placed_(model.cameras.size()) {}

  std::vector<bool> run() {
    collect_seen();
    join_cameras();
    for (std::size_t t = 0; t < model_.targets.size(); ++t) {
      if (model_.targets[t].stays || model_.targets[t].pieces.empty()) continue;
      lay_out(t);
      place_target(t);
    }
    while (true) {
      triangulate_static_tags();
      if (!resect_one()) break;
    }
    return placed_;
  }

 private:
  void collect_seen();
  void join_cameras();
  void lay_out(std::size_t target);
  void place_target(std::size_t target);
  void triangulate_static_tags();
  bool resect_one();
  [[nodiscard]] double misfit_px(const Sighting& sighting,
                                 const RigidTransform& world_from_piece,
                                 double size_m) const;
  [[nodiscard]] std::optional<RigidTransform> best_place(const Place& place) const;

  RigModel& model_;
  std::vector<bool> placed_;
  std::map<Place, std::vector<SeenPose>> seen_;  ///< For tags of known size.
};

void TagPlacer::collect_seen() {
  for (const Sighting& sighting : model_.sightings) {
    const RigidTarget& target = model_.targets[sighting.target];
    if (target.pieces.empty() || !target.pieces[sighting.piece].is_size_known) continue;
    SeenPose seen{&sighting, {}};
    for (const PlacedPlane& plane :
         place_plane(model_.cameras[sighting.camera].intrinsics,
                     corners_of(target.pieces[sighting.piece].size_m),
                     pixels_of(sighting))) {
      seen.camera_from_piece.push_back(plane.camera_from_plane);
    }
    if (seen.camera_from_piece.empty()) continue;
    seen_[{sighting.target, sighting.instant, sighting.piece}].push_back(std::move(seen));
  }
}

void TagPlacer::join_cameras() {
  const std::size_t count = model_.cameras.size();
  std::map<std::pair<std::size_t, std::size_t>, std::vector<RigidTransform>> proposals;
  for (const auto& [place, views] : seen_) {
    for (const SeenPose& a : views) {
      for (const SeenPose& b : views) {
        if (a.sighting->camera >= b.sighting->camera) continue;
        for (const RigidTransform& to_a : a.camera_from_piece) {
          for (const RigidTransform& to_b : b.camera_from_piece) {
            proposals[{a.sighting->camera, b.sighting->camera}].push_back(to_a *
                                                                          inverse(to_b));
          }
        }
      }
    }
  }
  std::vector<Link> links;
  for (const auto& [pair, candidates] : proposals) {
    links.push_back(medoid_transform(pair.first, pair.second, candidates));
  }
  // One or two sightings may agree by chance; flipped solutions always come in pairs.
  std::erase_if(links, [](const Link& link) { return link.support < 3; });
  std::vector<int> support(count, 0);
  for (const Link& link : links) {
    support[link.a] += link.support;
    support[link.b] += link.support;
  }
  const auto first = static_cast<std::size_t>(
      std::max_element(support.begin(), support.end()) - support.begin());
  const auto camera_from_first = propagate_poses(first, links, count);
  for (std::size_t c = 0; c < count; ++c) {
    placed_[c] = camera_from_first[c].has_value();
    if (placed_[c]) model_.cameras[c].world_from_camera = inverse(*camera_from_first[c]);
  }
}

double TagPlacer::misfit_px(const Sighting& sighting,
                            const RigidTransform& world_from_piece,
                            double size_m) const {
  const Camera camera = camera_of(model_.cameras[sighting.camera]);
  double worst = 0.0;
  for (int i = 0; i < 4; ++i) {
    const auto pixel = project(camera, world_from_piece * corner_in_tag(i, size_m));
    const double off =
        pixel ? glm::distance(*pixel,
                              sighting.corners[static_cast<std::size_t>(i)].pixel_px)
              : camera.intrinsics.width_px;
    worst = std::max(worst, off);
  }
  return worst;
}

/// Returns the tag pose with the lowest total error, among those from placed cameras.
std::optional<RigidTransform> TagPlacer::best_place(const Place& place) const {
  const auto found = seen_.find(place);
  if (found == seen_.end()) return std::nullopt;
  const double size_m =
      model_.targets[std::get<0>(place)].pieces[std::get<2>(place)].size_m;
  double minimum = std::numeric_limits<double>::infinity();
  std::optional<RigidTransform> best;
  for (const SeenPose& seen : found->second) {
    if (!placed_[seen.sighting->camera]) continue;
    for (const RigidTransform& camera_from_piece : seen.camera_from_piece) {
      const RigidTransform candidate =
          model_.cameras[seen.sighting->camera].world_from_camera * camera_from_piece;
      double sum = 0.0;
      for (const SeenPose& other : found->second) {
        if (!placed_[other.sighting->camera]) continue;
        sum += std::min(50.0, misfit_px(*other.sighting, candidate, size_m));
      }
      if (sum < minimum) {
        minimum = sum;
        best = candidate;
      }
    }
  }
  return best;
}

void TagPlacer::lay_out(std::size_t t) {
  RigidTarget& target = model_.targets[t];
  std::map<int, std::map<std::size_t, RigidTransform>> world_from_piece;
  for (const auto& [place, views] : seen_) {
    if (std::get<0>(place) != t) continue;
    if (const auto best = best_place(place)) {
      world_from_piece[std::get<1>(place)][std::get<2>(place)] = *best;
    }
  }
  std::map<std::pair<std::size_t, std::size_t>, std::vector<RigidTransform>> proposals;
  for (const auto& [instant, pieces] : world_from_piece) {
    for (const auto& [a, world_from_a] : pieces) {
      for (const auto& [b, world_from_b] : pieces) {
        if (a < b) proposals[{a, b}].push_back(inverse(world_from_a) * world_from_b);
      }
    }
  }
  std::vector<Link> links;
  for (const auto& [pair, candidates] : proposals) {
    links.push_back(medoid_transform(pair.first, pair.second, candidates));
  }
  const auto piece_from_first = propagate_poses(0, links, target.pieces.size());
  for (std::size_t i = 0; i < target.pieces.size(); ++i) {
    if (piece_from_first[i]) {
      target.pieces[i].target_from_piece = inverse(*piece_from_first[i]);
    } else {
      // Not placed: its sightings are ignored.
      std::erase_if(model_.sightings,
                    [&](const Sighting& s) { return s.target == t && s.piece == i; });
      seen_.clear();
    }
  }
  if (seen_.empty()) collect_seen();
}

void TagPlacer::place_target(std::size_t t) {
  RigidTarget& target = model_.targets[t];
  std::map<int, std::vector<const SeenPose*>> by_instant;
  for (const auto& [place, views] : seen_) {
    if (std::get<0>(place) != t) continue;
    for (const SeenPose& seen : views) {
      if (placed_[seen.sighting->camera]) by_instant[std::get<1>(place)].push_back(&seen);
    }
  }
  for (const auto& [instant, views] : by_instant) {
    double minimum = std::numeric_limits<double>::infinity();
    for (const SeenPose* proposer : views) {
      const Piece& own = target.pieces[proposer->sighting->piece];
      for (const RigidTransform& camera_from_piece : proposer->camera_from_piece) {
        const RigidTransform candidate =
            model_.cameras[proposer->sighting->camera].world_from_camera *
            camera_from_piece * inverse(own.target_from_piece);
        double sum = 0.0;
        for (const SeenPose* other : views) {
          const Piece& piece = target.pieces[other->sighting->piece];
          sum += std::min(
              50.0,
              misfit_px(
                  *other->sighting, candidate * piece.target_from_piece, piece.size_m));
        }
        if (sum < minimum) {
          minimum = sum;
          target.world_from_target[instant] = candidate;
        }
      }
    }
  }
}

/// Returns the approximate square through four points.
std::optional<Piece> square_through(const std::array<glm::dvec3, 4>& p) {
  const glm::dvec3 x = 0.5 * (p[1] - p[0] + p[2] - p[3]);
  const glm::dvec3 y = 0.5 * (p[0] - p[3] + p[1] - p[2]);  // Down the upright tag.
  const double size_m = 0.5 * (glm::length(x) + glm::length(y));
  if (!(size_m > 1e-3)) return std::nullopt;
  const glm::dvec3 ex = glm::normalize(x);
  const glm::dvec3 across = y - glm::dot(y, ex) * ex;
  if (glm::length(across) < 0.5 * size_m) return std::nullopt;
  const glm::dvec3 ey = glm::normalize(across);
  Piece piece;
  piece.target_from_piece = {
      glm::normalize(glm::quat_cast(glm::dmat3(ex, ey, glm::cross(ex, ey)))),
      0.25 * (p[0] + p[1] + p[2] + p[3])};
  piece.size_m = size_m;
  return piece;
}

void TagPlacer::triangulate_static_tags() {
  for (std::size_t t = 0; t < model_.targets.size(); ++t) {
    RigidTarget& target = model_.targets[t];
    if (!target.stays) continue;
    std::vector<std::vector<const Sighting*>> views(target.pieces.size());
    for (const Sighting& s : model_.sightings) {
      if (s.target == t && placed_[s.camera]) views[s.piece].push_back(&s);
    }
    bool any = false;
    for (std::size_t i = 0; i < target.pieces.size(); ++i) {
      std::array<glm::dvec3, 4> corners{};
      bool complete = views[i].size() >= 2;
      for (std::size_t c = 0; c < 4 && complete; ++c) {
        std::vector<glm::dvec3> origins;
        std::vector<glm::dvec3> directions;
        for (const Sighting* view : views[i]) {
          const RigCamera& camera = model_.cameras[view->camera];
          const auto ray = unproject(camera.intrinsics, view->corners[c].pixel_px);
          if (!ray) continue;
          origins.push_back(camera.world_from_camera.translation);
          directions.push_back(camera.world_from_camera.rotation * glm::dvec3(*ray, 1.0));
        }
        const auto p = nearest_to_rays(origins, directions);
        complete = p.has_value();
        if (p) corners[c] = *p;
      }
      const auto square = complete ? square_through(corners) : std::nullopt;
      Piece& piece = target.pieces[i];
      piece.is_placed = square.has_value();
      if (!square) continue;
      piece.target_from_piece = square->target_from_piece;
      piece.size_m = square->size_m;
      any = true;
    }
    if (any) target.world_from_target[0] = RigidTransform{};
  }
}

bool TagPlacer::resect_one() {
  for (std::size_t c = 0; c < placed_.size(); ++c) {
    if (placed_[c]) continue;
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec2> pixels;
    for (const Sighting& s : model_.sightings) {
      if (s.camera != c) continue;
      const RigidTarget& target = model_.targets[s.target];
      const auto pose = target.world_from_target.find(s.instant);
      if (pose == target.world_from_target.end()) continue;
      if (!target.pieces.empty() && !target.pieces[s.piece].is_placed) continue;
      for (int i = 0; i < s.count; ++i) {
        points.push_back(pose->second * corner_in_target(target, s, i));
        pixels.push_back(s.corners[static_cast<std::size_t>(i)].pixel_px);
      }
    }
    if (points.size() < 8) continue;
    const auto camera_from_world = resect(model_.cameras[c].intrinsics, points, pixels);
    if (!camera_from_world) continue;
    model_.cameras[c].world_from_camera = inverse(*camera_from_world);
    placed_[c] = true;
    return true;
  }
  return false;
}

}  // namespace

std::optional<Intrinsics> estimate_intrinsics_from_tags(
    std::span<const Sighting* const> sightings,
    LensModel lens,
    int width_px,
    int height_px) {
  constexpr std::size_t kMin = 8;
  constexpr std::size_t kMax = 60;
  // The largest tags are the most accurate.
  std::vector<std::pair<double, const Sighting*>> by_size;
  for (const Sighting* s : sightings) {
    if (s->count != 4) continue;
    by_size.emplace_back(
        glm::distance(s->corners[0].pixel_px, s->corners[2].pixel_px) +
            glm::distance(s->corners[1].pixel_px, s->corners[3].pixel_px),
        s);
  }
  if (by_size.size() < kMin) return std::nullopt;
  std::stable_sort(by_size.begin(), by_size.end(), [](const auto& a, const auto& b) {
    return a.first > b.first;
  });
  if (by_size.size() > kMax) by_size.resize(kMax);
  Intrinsics best;
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = 0.0;
  const double widest = lens == LensModel::kFisheye ? 1.0 : 3.0;
  for (double focal = 0.3; focal <= widest; focal *= 1.05) {
    Intrinsics k;
    k.lens = lens;
    k.width_px = width_px;
    k.height_px = height_px;
    k.focal_px = glm::dvec2(focal * width_px);
    k.centre_px = {0.5 * (width_px - 1), 0.5 * (height_px - 1)};
    double sum = 0.0;
    for (const auto& [size, s] : by_size) {
      const auto placed = place_plane(k, corners_of(1.0), pixels_of(*s));
      const double off_px = placed.empty() ? 5.0 : placed[0].misfit * k.focal_px.x;
      sum += std::min(off_px, 5.0);
    }
    maximum = std::max(maximum, sum);
    if (sum < minimum) {
      minimum = sum;
      best = k;
    }
  }
  if (maximum < 1.05 * minimum) return std::nullopt;
  return best;
}

std::vector<bool> place_by_tags(RigModel& model) {
  return TagPlacer(model).run();
}

}  // namespace marey::calib
