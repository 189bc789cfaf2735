// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/boards/read_markers.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <apriltag/apriltag.h>

namespace marey::capture {
namespace {

struct Cell {
  int x = 0;
  int y = 0;
};

/// Returns the cells in libapriltag's order: a quarter of the marker, ring by ring from
/// its top left, then the same quarter turned clockwise three times, and the centre.
std::vector<Cell> cells_by_quarters(int side) {
  std::vector<Cell> cells;
  for (int ring = 0; ring < side / 2; ++ring) {
    for (int x = ring; x < side - 1 - ring; ++x) cells.push_back({x, ring});
  }
  const std::size_t quarter = cells.size();
  while (cells.size() < 4 * quarter) {
    const Cell& last = cells[cells.size() - quarter];
    cells.push_back({side - 1 - last.y, last.x});
  }
  if (side % 2 == 1) cells.push_back({side / 2, side / 2});
  return cells;
}

}  // namespace

struct MarkerReader::Impl {
  std::vector<std::uint64_t> codes;
  std::vector<std::uint32_t> bit_x;
  std::vector<std::uint32_t> bit_y;
  std::string name = "markers";
  apriltag_family_t family{};
  apriltag_detector_t* detector = apriltag_detector_create();

  explicit Impl(const MarkerCodes& markers);
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { apriltag_detector_destroy(detector); }
};

MarkerReader::Impl::Impl(const MarkerCodes& markers) {
  const std::vector<Cell> cells = cells_by_quarters(markers.side);
  for (const Cell& cell : cells) {
    bit_x.push_back(static_cast<std::uint32_t>(cell.x + 1));
    bit_y.push_back(static_cast<std::uint32_t>(cell.y + 1));
  }
  for (const std::uint64_t rows : markers.codes) {
    std::uint64_t code = 0;
    for (const Cell& cell : cells) {
      const int bit = markers.side * markers.side - 1 - (cell.y * markers.side + cell.x);
      code = code << 1U | (rows >> static_cast<unsigned>(bit) & 1U);
    }
    codes.push_back(code);
  }
  family.ncodes = static_cast<std::uint32_t>(codes.size());
  family.codes = codes.data();
  family.width_at_border = markers.side + 2;
  family.total_width = markers.side + 4;
  family.nbits = static_cast<std::uint32_t>(cells.size());
  family.bit_x = bit_x.data();
  family.bit_y = bit_y.data();
  family.name = name.data();
  // libapriltag stores every code with every choice of wrong cells.
  constexpr std::size_t kManyCodes = 300;
  const int correctable = codes.size() > kManyCodes
                              ? std::min(markers.correctable_bits, 1)
                              : markers.correctable_bits;
  apriltag_detector_add_family_bits(detector, &family, correctable);
  detector->nthreads = 1;
  detector->quad_decimate = 1.0F;
  detector->quad_sigma = 0.0F;  // Other values would write into the caller's image.
  detector->refine_edges = true;
  // Weaker edges are mostly sensor noise (see capture/tags/detect_tags.cpp). On 720p
  // webcams this takes 21 ms a picture instead of 37 ms, and 1151 of 1153 markers stay.
  detector->qtp.min_white_black_diff = 20;
  detector->debug = false;
}

MarkerReader::MarkerReader(const MarkerCodes& markers)
    : impl_(std::make_unique<Impl>(markers)) {}
MarkerReader::MarkerReader(MarkerReader&&) noexcept = default;
MarkerReader& MarkerReader::operator=(MarkerReader&&) noexcept = default;
MarkerReader::~MarkerReader() = default;

std::vector<ReadMarker> MarkerReader::read(const cv::Mat& gray) {
  image_u8_t image{gray.cols, gray.rows, static_cast<int>(gray.step[0]), gray.data};
  zarray_t* found = apriltag_detector_detect(impl_->detector, &image);
  std::vector<ReadMarker> markers;
  for (int i = 0; i < zarray_size(found); ++i) {
    apriltag_detection_t* one = nullptr;
    zarray_get(found, i, static_cast<void*>(&one));
    ReadMarker& marker = markers.emplace_back();
    marker.id = one->id;
    for (int corner = 3; corner >= 0; --corner) {
      // libapriltag's corners begin at the bottom left and go the other way; its first
      // pixel has its centre at 0.5.
      marker.corners_px.emplace_back(static_cast<float>(one->p[corner][0] - 0.5),
                                     static_cast<float>(one->p[corner][1] - 0.5));
    }
  }
  apriltag_detections_destroy(found);
  return markers;
}

}  // namespace marey::capture
