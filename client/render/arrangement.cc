// Notation: a division gives every block its column, numbered in the order of their first blocks.  Width and
// height of a division grow with the scale, so that the largest scale that fits is found by halving.
#include "client/render/arrangement.h"

#include <algorithm>
#include <cstddef>

namespace affskel::client {
namespace {

using Division = std::vector<std::size_t>;

constexpr int kHalvings = 60;
constexpr double kBetter = 1e-9;  // so that rounding does not choose among equals

struct Column {
  double width = 0, height = 0;
  int blocks = 0;
};

std::vector<Column> columns_of(const std::vector<Block>& blocks, const Division& division, double scale) {
  std::vector<Column> columns;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    columns.resize(std::max(columns.size(), division[b] + 1));
    Column& column = columns[division[b]];
    column.width = std::max(column.width, scale * blocks[b].width + blocks[b].fixed_width);
    column.height += scale * blocks[b].height + blocks[b].fixed_height;
    ++column.blocks;
  }
  return columns;
}

double total_width(const std::vector<Column>& columns, double gap) {
  double width = gap * double(columns.size() - 1);
  for (const Column& column : columns) width += column.width;
  return width;
}

double total_height(const std::vector<Column>& columns) {
  double height = 0;
  for (const Column& column : columns) height = std::max(height, column.height);
  return height;
}

// The largest scale at which the division fits; 0 when none does.
double best_scale(const std::vector<Block>& blocks, const Division& division, double width, double tallest,
                  double gap) {
  double high = 0;  // at which no block fits alone
  for (const Block& block : blocks) {
    if (block.width > 0) high = std::max(high, 2 * width / block.width);
    if (block.height > 0) high = std::max(high, 2 * tallest / block.height);
  }
  double low = 0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    const std::vector<Column> columns = columns_of(blocks, division, middle);
    (total_width(columns, gap) <= width && total_height(columns) <= tallest ? low : high) = middle;
  }
  return low;
}

double filled_share(const std::vector<Block>& blocks, const Division& division, double scale, double width) {
  double area = 0;
  for (const Block& b : blocks)
    area += (scale * b.width + b.fixed_width) * (scale * b.height + b.fixed_height);
  return area / (width * std::max(1.0, total_height(columns_of(blocks, division, scale))));
}

// The next division: every block's column is at most one more than the largest before it.  False after the
// last.
bool advance(Division& division) {
  for (std::size_t b = division.size(); b-- > 1;) {
    const std::size_t most = *std::max_element(division.begin(), division.begin() + std::ptrdiff_t(b)) + 1;
    if (division[b] >= most) continue;
    ++division[b];
    std::fill(division.begin() + std::ptrdiff_t(b) + 1, division.end(), 0);
    return true;
  }
  return false;
}

Arrangement place(const std::vector<Block>& blocks, const Division& division, double scale, double width,
                  double gap) {
  const std::vector<Column> columns = columns_of(blocks, division, scale);
  Arrangement result;
  result.scale = scale;
  result.height = total_height(columns);
  const double spare = std::max(0.0, width - total_width(columns, gap)) / double(columns.size());
  std::vector<double> left(columns.size(), 0), top(columns.size(), 0), between(columns.size(), 0);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (c > 0) left[c] = left[c - 1] + columns[c - 1].width + spare + gap;
    between[c] = (result.height - columns[c].height) / (columns[c].blocks + 1);
    top[c] = between[c];
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::size_t c = division[b];
    const double wide = scale * blocks[b].width + blocks[b].fixed_width;
    result.places.push_back({left[c] + (columns[c].width + spare - wide) / 2, top[c]});
    top[c] += scale * blocks[b].height + blocks[b].fixed_height + between[c];
  }
  return result;
}

}  // namespace

Arrangement arrange(const std::vector<Block>& blocks, double width, double tallest, double gap) {
  Division division(blocks.size(), 0), best = division;
  double most = -1, best_at = 0;
  do {
    const double scale = best_scale(blocks, division, width, tallest, gap);
    const double filled = scale > 0 ? filled_share(blocks, division, scale, width) : 0;
    if (filled <= most + kBetter) continue;
    most = filled;
    best = division;
    best_at = scale;
  } while (advance(division));
  return place(blocks, best, best_at, width, gap);
}

}  // namespace affskel::client
