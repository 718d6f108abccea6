// Begin with svg_curves(). A Scale maps values to positions, a Canvas collects the elements.
#include "scenes/report/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "scenes/report/page.h"

namespace sunder::scenes {
namespace {

constexpr double kPlotWidth = 720, kPlotHeight = 460;  // size of the picture
constexpr double kLeft = 70, kRight = 20, kTop = 60, kBottom = 60;
constexpr double kTick = 5, kDot = 4.5;
constexpr double kLegendY = 42, kLegendGap = 16;     // vertical position, and gap between entries
constexpr double kLetter = 6.6, kLetterHeight = 12;  // approximate size of a letter

// Distinguishable with red-green colour blindness (Okabe and Ito), on light and dark backgrounds.
constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#e69f00", "#56b4e9", "#888888", "#a6761d"};
constexpr const char* kPlotStyle =
    "<style>.plot { font: 12px sans-serif; color: #444; } .plot text { fill: currentColor; }"
    " @media (prefers-color-scheme: dark) { .plot { color: #bbb; } }</style>\n";

/// Formats a length in the picture.
std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

/// Maps values to positions between `low` and `high` in the picture.
class Scale {
 public:
  Scale(bool logarithmic, std::span<const double> values, double low, double high)
      : logarithmic_(logarithmic), low_(low), high_(high) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const double value : values) {
      if (!is_drawable(value)) continue;
      least = std::min(least, to_linear(value));
      most = std::max(most, to_linear(value));
    }
    if (least > most) least = 0, most = 1;
    const double margin = least == most ? 0.5 : 0.06 * (most - least);
    first_ = least - margin;
    last_ = most + margin;
  }

  /// Starts a linear axis of non-negative values at 0.
  void begin_at_zero() {
    if (!logarithmic_) first_ = 0;
  }

  double place(double value) const {
    const double share = is_drawable(value) ? (to_linear(value) - first_) / (last_ - first_)
                                            : (value > 0 ? 1.0 : 0.0);
    return low_ + std::clamp(share, 0.0, 1.0) * (high_ - low_);
  }

  /// Returns round values on the axis: powers of ten with their doubles and fives, or even steps.
  std::vector<double> ticks() const {
    const double decades = last_ - first_;
    if (!logarithmic_) return steps(first_, last_);
    if (decades < 1) return steps(std::pow(10, first_), std::pow(10, last_));
    std::vector<double> values;
    for (double power = std::floor(first_); power <= last_; ++power) {
      for (const double digit : {1.0, 2.0, 5.0}) {
        if (digit > 1 && decades > 3) break;
        const double value = digit * std::pow(10, power);
        if (to_linear(value) >= first_ && to_linear(value) <= last_) values.push_back(value);
      }
    }
    return values;
  }

 private:
  bool is_drawable(double value) const {
    return std::isfinite(value) && (!logarithmic_ || value > 0);
  }
  double to_linear(double value) const { return logarithmic_ ? std::log10(value) : value; }
  static std::vector<double> steps(double first, double last) {
    const double rough = (last - first) / 8, power = std::pow(10, std::floor(std::log10(rough)));
    const double step = power * (rough / power < 2 ? 2 : rough / power < 5 ? 5 : 10);
    std::vector<double> values;
    for (double i = std::ceil(first / step); i * step <= last; ++i) {
      values.push_back(i * step + 0.0);  // no -0
    }
    return values;
  }

  bool logarithmic_;
  double low_, high_;
  double first_ = 0, last_ = 1;
};

/// The SVG elements so far.
class Canvas {
 public:
  struct Place {
    double x, y;
  };

  explicit Canvas(const Axes& axes) {
    const std::string size = number(kPlotWidth) + " " + number(kPlotHeight);
    svg_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" width=\"" +
           number(kPlotWidth) + "\" height=\"" + number(kPlotHeight) + "\" viewBox=\"0 0 " + size +
           "\" role=\"img\">\n" + kPlotStyle;
    text({kPlotWidth / 2, 20}, axes.title, "middle", " font-weight=\"bold\"");
    text({(kLeft + kPlotWidth - kRight) / 2, kPlotHeight - 8}, axes.x.name, "middle");
    text({0, 0}, axes.y.name, "middle",
         " transform=\"translate(14 " + number((kTop + kPlotHeight - kBottom) / 2) +
             ") rotate(-90)\"");
    line({{kLeft, kTop},
          {kLeft, kPlotHeight - kBottom},
          {kPlotWidth - kRight, kPlotHeight - kBottom}},
         "currentColor", 1);
  }

  void line(const std::vector<Place>& places, const std::string& color, double width,
            double opacity = 1) {
    svg_ += "<polyline fill=\"none\" stroke=\"" + color + "\" stroke-width=\"" + number(width) +
            "\" stroke-opacity=\"" + number(opacity) + "\" points=\"";
    for (const Place& p : places) svg_ += number(p.x) + "," + number(p.y) + " ";
    svg_ += "\"/>\n";
  }
  void dot(const Place& at, const std::string& color, const std::string& note) {
    shape("<circle cx=\"" + number(at.x) + "\" cy=\"" + number(at.y) + "\" r=\"" + number(kDot) +
              "\" fill=\"" + color + "\"",
          "circle", note);
  }
  void box(const Place& corner, double width, double height, const std::string& color,
           const std::string& note) {
    shape("<rect x=\"" + number(corner.x) + "\" y=\"" + number(corner.y) + "\" width=\"" +
              number(width) + "\" height=\"" + number(height) + "\" fill=\"" + color + "\"",
          "rect", note);
  }
  /// Adds text; `anchor` is start, middle or end.
  void text(const Place& at, const std::string& words, const char* anchor,
            const std::string& attributes = "") {
    if (words.empty()) return;
    svg_ += "<text x=\"" + number(at.x) + "\" y=\"" + number(at.y) + "\" text-anchor=\"" + anchor +
            "\"" + attributes + ">" + escaped(words) + "</text>\n";
  }
  void x_ticks(const Scale& scale) {
    for (const double value : scale.ticks()) {
      const double x = scale.place(value), y = kPlotHeight - kBottom;
      line({{x, y}, {x, y + kTick}}, "currentColor", 1);
      text({x, y + kTick + 13}, rounded(value, 6), "middle");
    }
  }
  void y_ticks(const Scale& scale) {
    for (const double value : scale.ticks()) {
      const double y = scale.place(value);
      line({{kLeft - kTick, y}, {kLeft, y}}, "currentColor", 1);
      line({{kLeft, y}, {kPlotWidth - kRight, y}}, "currentColor", 1, 0.15);
      text({kLeft - kTick - 3, y + 4}, rounded(value, 6), "end");
    }
  }
  std::string done() { return svg_ + "</svg>\n"; }

 private:
  void shape(const std::string& tag, const std::string& kind, const std::string& note) {
    svg_ +=
        tag + (note.empty() ? "/>\n" : "><title>" + escaped(note) + "</title></" + kind + ">\n");
  }

  std::string svg_;
};

/// Places labels next to dots so that they overlap neither each other nor a dot, if possible.
class Labels {
 public:
  void keep_clear(const Canvas::Place& dot) {
    taken_.push_back({dot.x - kDot, dot.y - kDot, dot.x + kDot, dot.y + kDot});
  }
  void put(Canvas& canvas, const Canvas::Place& dot, const std::string& words) {
    struct Side {
      double x, y;
      const char* anchor;
    };
    constexpr Side kSides[] = {
        {7, -5, "start"}, {7, 14, "start"}, {-7, -5, "end"}, {-7, 14, "end"}};
    const double width = kLetter * static_cast<double>(words.size());
    const auto box = [&](const Side& side) {
      const double left = dot.x + side.x - (side.x < 0 ? width : 0), bottom = dot.y + side.y + 2;
      return Box{left, bottom - kLetterHeight, left + width, bottom};
    };
    const auto free = std::find_if(std::begin(kSides), std::end(kSides),
                                   [&](const Side& side) { return is_free(box(side)); });
    const Side& side = free == std::end(kSides) ? kSides[0] : *free;
    taken_.push_back(box(side));
    canvas.text({dot.x + side.x, dot.y + side.y}, words, side.anchor);
  }

 private:
  struct Box {
    double left, top, right, bottom;
  };
  bool is_free(const Box& box) const {
    return box.left > kLeft && box.right < kPlotWidth && box.bottom < kPlotHeight - kBottom &&
           std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) {
             return box.left < other.right && other.left < box.right && box.top < other.bottom &&
                    other.top < box.bottom;
           });
  }

  std::vector<Box> taken_;
};

Scale y_scale(const Axis& axis, std::span<const double> values) {
  return Scale(axis.logarithmic, values, kPlotHeight - kBottom, kTop);
}

}  // namespace

std::string svg_curves(const Axes& axes, std::span<const Curve> curves) {
  std::vector<double> xs, ys;
  for (const Curve& curve : curves) {
    for (const PlotPoint& point : curve.points) {
      xs.push_back(point.x);
      ys.push_back(point.y);
    }
  }
  const Scale x(axes.x.logarithmic, xs, kLeft, kPlotWidth - kRight), y = y_scale(axes.y, ys);
  Canvas canvas(axes);
  canvas.x_ticks(x);
  canvas.y_ticks(y);
  double legend = kLeft;
  Labels labels;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Curve& curve = curves[i];
    const std::string color = kColors[i % std::size(kColors)];
    std::vector<Canvas::Place> places;
    for (const PlotPoint& point : curve.points) {
      places.push_back({x.place(point.x), y.place(point.y)});
      if (!curve.dots) continue;
      canvas.dot(places.back(), color, point.note);
      labels.keep_clear(places.back());
    }
    if (curve.line) canvas.line(places, color, 1.5);
    if (curve.name.empty()) continue;
    canvas.box({legend, kLegendY - 9}, 10, 10, color, "");
    canvas.text({legend + kLegendGap, kLegendY}, curve.name, "start");
    legend += 2 * kLegendGap + kLetter * static_cast<double>(curve.name.size());
  }
  for (const Curve& curve : curves) {
    for (const PlotPoint& point : curve.points) {
      if (!point.label.empty())
        labels.put(canvas, {x.place(point.x), y.place(point.y)}, point.label);
    }
  }
  return canvas.done();
}

std::string svg_bars(const Axes& axes, std::span<const Bar> bars) {
  std::vector<double> values;
  for (const Bar& bar : bars) values.push_back(bar.value);
  Scale y = y_scale(axes.y, values);
  y.begin_at_zero();
  Canvas canvas(axes);
  canvas.y_ticks(y);
  const double pitch =
      (kPlotWidth - kRight - kLeft) / static_cast<double>(std::max<std::size_t>(1, bars.size()));
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double left = kLeft + pitch * static_cast<double>(i), top = y.place(bars[i].value);
    canvas.box({left + 0.1 * pitch, top}, 0.8 * pitch, kPlotHeight - kBottom - top, kColors[0],
               bars[i].name + ": " + rounded(bars[i].value));
    canvas.text({left + pitch / 2, kPlotHeight - kBottom + kTick + 13}, bars[i].name, "middle");
  }
  return canvas.done();
}

}  // namespace sunder::scenes
