#include "ruche/study/validation/choice_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ruche/study/calibration/plot.hpp"
#include "ruche/study/html_page.hpp"

namespace ruche {
namespace {

const ValueSeries* series_of(const ExperimentOutcome& o, const std::string& variant,
                             const std::string& metric) {
    const auto found = std::ranges::find_if(
        o.series, [&](const ValueSeries& s) { return s.variant == variant && s.metric == metric; });
    return found == o.series.end() ? nullptr : &*found;
}

/// All variants of the experiments, in the order in which they come.
std::vector<std::string> all_choices(const std::vector<const ExperimentOutcome*>& list) {
    std::vector<std::string> names;
    for (const ExperimentOutcome* o : list)
        for (const VariantSpec& variant : o->experiment.variants)
            if (std::ranges::find(names, variant.name) == names.end()) names.push_back(variant.name);
    return names;
}

/// The share of the default, and the value itself.
std::string share_cell(const Estimate& e, const Estimate& base) {
    const Estimate share = quotient(e, base);
    return fmt::format("× {:.3f} ± {:.2g}<br><small>{}{}</small>", share.value, share.uncertainty, to_text(e),
                       share.certain ? "" : " (!)");
}

std::string metric_row(const ExperimentOutcome& o, const MetricSpec& metric,
                       const std::vector<std::string>& names) {
    const std::string unit = metric.unit.empty() ? "" : " (" + metric.unit + ")";
    std::string html = fmt::format("<tr><td><a href=\"#{0}\">{0}</a><br><small>{1}{2}</small></td>",
                                   o.experiment.name, html_escaped(metric.name), html_escaped(unit));
    const std::string& first = o.experiment.variants.front().name;
    const Estimate& base = o.of(first, metric.name).y.front();
    for (const std::string& name : names) {
        const ValueSeries* s = series_of(o, name, metric.name);
        if (s == nullptr)
            html += "<td></td>";
        else
            html += fmt::format("<td class=\"n\">{}</td>",
                                name == first ? to_html(base) : share_cell(s->y.front(), base));
    }
    return html + "</tr>\n";
}

}  // namespace

std::string choice_table(const Validation& validation) {
    std::vector<const ExperimentOutcome*> list;
    for (const ExperimentOutcome& o : validation.experiments)
        if (o.experiment.set == ExperimentSet::numerics) list.push_back(&o);
    if (list.empty()) return {};
    const std::vector<std::string> names = all_choices(list);
    std::string html = "<h2>What each choice does</h2>\n" +
                       html_paragraph(
                           "Ruche's own choice, then the share of it that another choice gives, "
                           "estimated from the shares on each mesh. An empty cell: the choice has nothing "
                           "to act on.") +
                       "<table class=\"wide\"><tr><th></th>";
    for (const std::string& name : names) html += "<th>" + html_escaped(name) + "</th>";
    html += "</tr>\n";
    for (const ExperimentOutcome* o : list)
        for (const MetricSpec& metric : o->experiment.metrics) html += metric_row(*o, metric, names);
    return html + "</table>\n";
}

}  // namespace ruche
