#include "study/curves.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "compare/statistics.h"

namespace voxref {

ChartPoint chart_point(double x, double y, const std::string& label, double error) {
  ChartPoint point;
  point.x = x;
  point.y = y;
  point.error = error;
  point.label = label;
  return point;
}

Series curve(const Table& table, const std::string& x, const std::string& y, const std::string& title, ChartStyle style,
             const std::pair<std::string, double>& where) {
  Series series{title, style};
  for (size_t i = 0; i < table.rows.size(); ++i)
    if ((where.first.empty() || table.number(i, where.first) == where.second) &&
        std::holds_alternative<double>(table.rows[i][table.column(y)]))
      series.points.push_back(chart_point(table.number(i, x), table.number(i, y)));
  return series;
}

Series theory_curve(const Table& table, const std::string& x, const std::string& y, const std::string& title,
                    const std::string& beside, const std::pair<std::string, double>& where) {
  Series series = curve(table, x, y, title, ChartStyle::dashes, where);
  series.color_of = beside;
  return series;
}

Series level_line(double y, double from, double to, const std::string& title) {
  return {title, ChartStyle::dashes, {chart_point(from, y), chart_point(to, y)}};
}

double value_at(const Series& series, double x) {
  for (const ChartPoint& point : series.points)
    if (point.x == x) return point.y;
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> detrended(std::span<const double> values) {
  const double average = mean(values), middle = 0.5 * (static_cast<double>(values.size()) - 1.0);
  double slope = 0.0, squares = 0.0;
  for (size_t i = 0; i < values.size(); ++i) {
    slope += (double(i) - middle) * values[i];
    squares += (double(i) - middle) * (double(i) - middle);
  }
  slope /= squares;
  std::vector<double> left;
  for (size_t i = 0; i < values.size(); ++i)
    left.push_back((values[i] - average - slope * (double(i) - middle)) / average);
  return left;
}

double ripple(std::span<const double> values) {
  const std::vector<double> left = detrended(values);
  const auto [low, high] = std::minmax_element(left.begin(), left.end());
  return *high - *low;
}

double spread_over_mean(std::span<const double> values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return (*high - *low) / mean(values);
}

std::vector<double> harmonics(std::span<const double> values, size_t periods, size_t count) {
  const std::vector<double> left = detrended(values);
  const auto n = static_cast<double>(left.size());
  std::vector<double> result;
  for (size_t k = 1; k <= count; ++k) {
    std::complex<double> sum = 0.0;
    for (size_t i = 0; i < left.size(); ++i)
      sum += left[i] * std::polar(1.0, -2.0 * std::numbers::pi * double(k * periods) * double(i) / n);
    result.push_back(2.0 * std::abs(sum) / n);
  }
  return result;
}

double breaks_at(std::span<const ChartPoint> points, double limit) {
  if (points.empty()) return std::numeric_limits<double>::quiet_NaN();
  for (size_t i = 0; i < points.size(); ++i) {
    if (std::isnan(points[i].y)) return std::numeric_limits<double>::quiet_NaN();
    if (points[i].y <= limit) continue;
    if (i == 0) return points[0].x;
    const ChartPoint &good = points[i - 1], &bad = points[i];
    return good.x + (bad.x - good.x) * (limit - good.y) / (bad.y - good.y);
  }
  return points.back().x;
}

}  // namespace voxref
