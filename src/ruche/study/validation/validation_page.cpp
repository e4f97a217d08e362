#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ruche/output/packed_arrays.hpp"
#include "ruche/study/calibration/plot.hpp"
#include "ruche/study/html_page.hpp"
#include "ruche/study/validation/choice_table.hpp"
#include "ruche/study/validation/validation.hpp"

namespace ruche {
namespace {

constexpr std::string_view how_to_read =
    R"(Values are those on the finest mesh, ± what discretisation may still change (grid convergence index); a
check holds when it does for everything in that range and all runs are certified equilibria; it is not resolved
when it does for a part of the range, so that finer meshes are needed to tell. Error bars are what a
print thicker or thinner by the experiment's spread would give. Where three meshes approach a limit in order, the
observed order and Richardson's estimate of the limit stand below the value. Measured points stand only in the
paper's pictures and are not drawn.)";

std::string verdict_cell(Verdict verdict) {
    static constexpr const char* classes[] = {"good", "open", "bad"};
    return fmt::format("<td class=\"{}\">{}</td>", classes[static_cast<std::size_t>(verdict)],
                       to_text(verdict));
}

std::string overview(const Validation& v) {
    std::string rows;
    for (const ExperimentOutcome& o : v.experiments) {
        const auto held = std::ranges::count(o.checks, Verdict::holds, &CheckOutcome::verdict);
        const bool any_fails =
            std::ranges::find(o.checks, Verdict::fails, &CheckOutcome::verdict) != o.checks.end();
        rows += fmt::format(
            "<tr><td><a href=\"#{0}\">{0}</a></td><td>{1}</td><td class=\"n\">{2}</td>"
            "<td class=\"{5}\">{3} of {4} checks hold</td></tr>\n",
            o.experiment.name, html_escaped(o.experiment.title), o.runs.size(), held, o.checks.size(),
            held == std::ssize(o.checks) ? "good"
            : any_fails                  ? "bad"
                                         : "open");
    }
    return "<table><tr><th></th><th></th><th>runs</th><th></th></tr>\n" + rows + "</table>\n";
}

std::string check_table(const ExperimentOutcome& o) {
    std::string html = "<table>\n";
    for (const CheckOutcome& c : o.checks) {
        std::string details;
        for (const std::string& text : c.details) details += "<br>" + html_escaped(text);
        html += fmt::format(
            "<tr>{}<td>{}<details><summary><small>{} values</small></summary><small>{}</small>"
            "</details></td></tr>\n",
            verdict_cell(c.verdict), html_escaped(c.check.says), c.details.size(), details);
    }
    return html + "</table>\n";
}

/// One plot per metric with a label; metrics with the same label share one.
std::string plots(const ExperimentOutcome& o) {
    const Experiment& e = o.experiment;
    if (e.sweep.values.size() < 2) return {};
    std::vector<Plot> drawn;
    for (const MetricSpec& metric : e.metrics) {
        if (metric.label.empty()) continue;
        auto plot = std::ranges::find(drawn, metric.label, &Plot::y_label);
        if (plot == drawn.end()) {
            drawn.push_back({.title = e.title,
                             .x_label = e.sweep.label,
                             .y_label = metric.label,
                             .width_px = 540,
                             .height_px = 400});
            plot = drawn.end() - 1;
        }
        const bool first = plot->series.empty();
        std::size_t colour = 0;
        for (const ValueSeries& s : o.series) {
            if (s.metric != metric.name) continue;
            PlotSeries curve{.label = e.variants.size() == 1 ? metric.name
                                      : first                ? s.variant
                                                             : fmt::format("{}, {}", s.variant, metric.name),
                             .colour = plot_colour(colour++),
                             .x = s.x,
                             .dashed = !first,
                             .low = s.low,
                             .high = s.high};
            for (const Estimate& y : s.y) curve.y.push_back(y.value);
            plot->series.push_back(std::move(curve));
        }
    }
    std::string svg;
    for (Plot& plot : drawn) {
        for (const ReferenceCurve& r : e.references)
            if (plot.y_label == (r.axis.empty() ? drawn.front().y_label : r.axis))
                plot.series.push_back(
                    {.label = r.label, .colour = "#000000", .x = r.x, .y = r.y, .dots = true, .size = 3.0});
        svg += svg_plot(plot);
    }
    return "<div class=\"plots\">" + svg + "</div>\n";
}

/// Metrics over variants and the sweep.
std::string value_table(const ExperimentOutcome& o) {
    const Experiment& e = o.experiment;
    std::string html = "<table class=\"wide\"><tr><th>variant</th>";
    if (!e.sweep.key.empty()) html += "<th>" + html_escaped(e.sweep.key) + "</th>";
    for (const MetricSpec& m : e.metrics)
        html += fmt::format("<th>{}{}</th>", html_escaped(m.name), m.unit.empty() ? "" : " (" + m.unit + ")");
    html += "</tr>\n";
    for (const VariantSpec& variant : e.variants) {
        const bool there =
            std::ranges::any_of(o.series, [&](const ValueSeries& s) { return s.variant == variant.name; });
        if (!there) continue;
        const ValueSeries& first = o.of(variant.name, e.metrics.front().name);
        for (std::size_t i = 0; i < first.x.size(); ++i) {
            html += fmt::format("<tr><td>{}</td>", html_escaped(variant.name));
            if (!e.sweep.key.empty()) html += fmt::format("<td class=\"n\">{:g}</td>", first.x[i]);
            for (const MetricSpec& m : e.metrics) {
                const Estimate& value = o.of(variant.name, m.name).y[i];
                html += fmt::format("<td class=\"n\">{}</td>", to_html(value));
            }
            html += "</tr>\n";
        }
    }
    return html + "</table>\n";
}

std::string orders(const ExperimentOutcome& o) {
    std::vector<double> seen;
    for (const ValueSeries& s : o.series)
        for (const Estimate& y : s.y)
            if (std::isfinite(y.order)) seen.push_back(y.order);
    if (seen.empty()) return {};
    std::ranges::sort(seen);
    return html_paragraph(
        fmt::format("Observed orders of convergence: {} values from {:.2f} to {:.2f}, median {:.2f}.",
                    seen.size(), seen.front(), seen.back(), seen[seen.size() / 2]));
}

std::string pictures(const ExperimentOutcome& o) {
    std::string html;
    for (std::size_t i = 0; i < o.runs.size(); ++i)
        if (!o.outcomes[i].picture.empty())
            html += fmt::format("<p><img alt=\"{}\" src=\"data:image/png;base64,{}\"></p>\n",
                                html_escaped(o.runs[i].picture_title), base64(o.outcomes[i].picture));
    return html;
}

std::string run_list(const ExperimentOutcome& o) {
    std::string html =
        "<details><summary>Each run and the command that repeats it</summary>\n<table class=\"wide\">"
        "<tr><th>triangles</th><th>s</th><th></th><th></th></tr>\n";
    for (std::size_t i = 0; i < o.runs.size(); ++i) {
        const RunOutcome& r = o.outcomes[i];
        html += fmt::format(
            "<tr><td class=\"n\">{}</td><td "
            "class=\"n\">{:.1f}</td><td{}>{}</td><td><code>{}</code></td></tr>\n",
            r.triangles, r.seconds, r.certain ? "" : " class=\"bad\"",
            r.certain ? "certified" : html_escaped("not certified: " + r.message),
            html_escaped(o.runs[i].command));
    }
    return html + "</table></details>\n";
}

std::string experiment_section(const ExperimentOutcome& o) {
    const Experiment& e = o.experiment;
    return fmt::format("<h2 id=\"{}\">{}</h2>\n", e.name, html_escaped(e.title)) + html_paragraph(e.shows) +
           check_table(o) + plots(o) + pictures(o) + value_table(o) + orders(o) +
           "<p><b>What is known.</b> " + html_escaped(e.known) + "</p>\n" + run_list(o);
}

}  // namespace

std::string validation_page(const Validation& v) {
    double work = 0.0;
    std::size_t runs = 0;
    for (const ExperimentOutcome& o : v.experiments) {
        runs += o.runs.size();
        for (const RunOutcome& r : o.outcomes) work += r.seconds;
    }
    std::string html = html_paragraph(
        fmt::format(
            "{}{} runs, {:.0f} s of computing in all, {} at a time; this time {} of them in {:.0f} s. ",
            v.quick ? "Quick subset: " : "", runs, work, v.jobs, v.computed, v.seconds) +
        std::string(how_to_read));
    html += overview(v) + choice_table(v);
    for (const ExperimentOutcome& o : v.experiments) html += experiment_section(o);
    return html_page("Ruche against the paper's experiments", html);
}

}  // namespace ruche
