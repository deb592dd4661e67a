#pragma once
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "study/chart.h"
#include "study/table.h"

namespace voxref {

ChartPoint chart_point(double x, double y, const std::string& label = {}, double error = 0.0);

/// Columns of a table as a series; both hold numbers. Rows where `y` is empty are left out.
/// @param where a column and the number that it must hold; no column: all rows
Series curve(const Table& table, const std::string& x, const std::string& y, const std::string& title,
             ChartStyle style = ChartStyle::line_points, const std::pair<std::string, double>& where = {});

/// The same as dashes in the colour of the series that it stands beside.
Series theory_curve(const Table& table, const std::string& x, const std::string& y, const std::string& title,
                    const std::string& beside, const std::pair<std::string, double>& where = {});

/// A dashed horizontal line.
Series level_line(double y, double from, double to, const std::string& title);

/// NaN where the series has no point at x.
double value_at(const Series& series, double x);

/// What is left of evenly spaced values after their best straight line is taken off, over their mean.
std::vector<double> detrended(std::span<const double> values);

/// Largest less smallest of the detrended values.
double ripple(std::span<const double> values);

/// Largest less smallest of the values, over their mean.
double spread_over_mean(std::span<const double> values);

/// Amplitudes of the first harmonics of the detrended values, which cover `periods` whole periods.
std::vector<double> harmonics(std::span<const double> values, size_t periods, size_t count);

/// Where a curve first rises above `limit`: between the last point that does not and the first that does, linearly.
/// @param points from where the method works to where it fails @returns the last x where it never does, the first where
/// it does from the start; NaN where a value before that is not a number, or there are no points
double breaks_at(std::span<const ChartPoint> points, double limit);

}  // namespace voxref
