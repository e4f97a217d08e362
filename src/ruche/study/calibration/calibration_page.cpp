#include "ruche/study/calibration/calibration_page.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ruche/study/calibration/calibration_plots.hpp"
#include "ruche/study/calibration/plot.hpp"
#include "ruche/study/html_page.hpp"

namespace ruche {
namespace {

std::string section(const std::string& title, const std::string& text, const std::string& plots) {
    if (plots.empty()) return {};
    return fmt::format("<h2>{}</h2>\n{}<div class=\"plots\">\n{}</div>\n", title, html_paragraph(text),
                       plots);
}

std::string value_rows(const CardSet& set) {
    std::string rows;
    for (const Field<Material>& field : fields<Material>()) {
        const auto found = set.values.find(std::string(bare_name(info(field))));
        if (found == set.values.end()) continue;
        const CardValue& value = found->second;
        const bool doubtful = value.source.find("assumed") != std::string::npos ||
                              value.source.find("NOT IDENTIFIABLE") != std::string::npos;
        const std::string interval =
            value.interval ? fmt::format("{:.5g} to {:.5g}", value.interval->at(0), value.interval->at(1))
                           : "";
        rows += fmt::format(
            "<tr><td>{}</td><td class=\"n\">{:.6g}</td><td>{}</td><td "
            "class=\"n\">{}</td><td{}>{}</td></tr>\n",
            found->first, value.value, html_escaped(std::string(field.unit)), interval,
            doubtful ? " class=\"bad\"" : "", html_escaped(value.source));
    }
    return rows;
}

std::string values(const Calibration& c) {
    std::string html;
    for (const CardSet& set : c.card.sets)
        html += fmt::format(
            "<h2>Values at a pre-stretch of {:g}</h2>\n<table><tr><th>value</th><th></th><th>unit</th>"
            "<th>95 % interval</th><th>from</th></tr>\n{}</table>\n",
            set.prestretch, value_rows(set));
    if (c.card.printed_thickness)
        html += fmt::format("<p>Thickness of the print: {:.4g} mm, {}.</p>\n",
                            c.card.printed_thickness->value, html_escaped(c.card.printed_thickness->source));
    return html;
}

std::string fit_table(const CalibratedSet& set) {
    std::string rows;
    for (std::size_t i = 0; i < set.curves.size(); ++i) {
        const double angle = set.curves[i].angle_deg;
        std::string left_out;
        for (const LeftOutOrientation& l : set.fit.left_out)
            if (l.angle_deg == angle) left_out = fmt::format("{:.2f} %", 100.0 * l.error);
        std::string band;
        if (!set.fit.bands.empty())
            band = fmt::format("{:.2f} % of the largest, {:.2f} % of itself",
                               100.0 * set.fit.bands[i].over_full_scale, 100.0 * set.fit.bands[i].over_value);
        const double nu = set.poissons_ratios[i];
        rows += fmt::format(
            "<tr><td>{}</td><td>{}</td><td class=\"n\">{:.3f}</td><td class=\"n\">{:.2f} %</td>"
            "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
            html_escaped(set.curves[i].name), set.tests[i].used_cycles(), set.tests[i].largest_stretch(),
            100.0 * set.fit.rms[i], band, left_out, std::isnan(nu) ? "" : fmt::format("{:.3f}", nu));
    }
    return "<table><tr><th>test</th><th>fitted</th><th>up to stretch</th><th>rms of the fit</th>"
           "<th>force known within (95 %)</th><th>predicted by the others</th><th>-E22/E11</th></tr>\n" +
           rows + "</table>\n";
}

std::string fit_text(const CalibratedSet& set, FitMode mode) {
    std::string html =
        "<p>" + html_escaped(mode == FitMode::joint
                                 ? "All orientations at once; transverse and shear strain free."
                                 : "Each axis by itself, as the paper does.");
    if (set.grip_rounds > 0)
        html += fmt::format(
            " The clamped samples were simulated {} times; their grips change the force by up to "
            "{:.2f} %.",
            set.grip_rounds, 100.0 * set.largest_grip_effect);
    html += "</p>\n" + fit_table(set);
    if (!set.fit.correlations.empty()) {
        html += "<p>Hardly told apart by these data: ";
        for (const Correlation& c : set.fit.correlations) {
            const auto name = [](std::size_t i) {
                for (const Field<Material>& field : fields<Material>())
                    if (const auto* m = std::get_if<double Material::*>(&field.member);
                        m != nullptr && *m == law_parameters[i])
                        return std::string(bare_name(info(field)));
                return std::string();
            };
            html += fmt::format("{} and {} ({:+.3f}); ", name(c.first), name(c.second), c.value);
        }
        html += "a change of one is made up for by the other.</p>\n";
    }
    if (set.sheared_alpha_3)
        html += fmt::format(
            "<p>The shear tests, the free sides of their samples simulated, give alpha_3 = {:.4g} "
            "({:.4g} to {:.4g}) MPa; the tension tests {:.4g} MPa.</p>\n",
            set.sheared_alpha_3->value, set.sheared_alpha_3->low, set.sheared_alpha_3->high,
            set.fit.material.alpha_3);
    const FabricModulus& m = set.fabric_modulus;
    html += fmt::format(
        "<p>Young's modulus of the fabric under plastic: secant {:.4g} ± {:.2g}, tangent {:.4g} ± {:.2g} "
        "(spread over "
        "orientations), working {:.4g} MPa; in the card {:.4g} MPa. A narrow strip with 0.6 mm of plastic "
        "gets a "
        "curvature of {:.4g}/mm, with the working value {:.4g}/mm.</p>\n",
        m.secant, m.secant_spread, m.tangent, m.tangent_spread, m.working,
        set.fit.material.fabric_youngs_modulus, set.curvature_used, set.curvature_working);
    return html;
}

std::string printed(const Calibration& c) {
    if (!c.printed) return {};
    std::string html = fmt::format(
        "<h2>Printed samples</h2>\n<p>{} = {:.4g} ({:.4g} to {:.4g}) meets the radii "
        "best.</p>\n<table><tr><th>sample</th><th>measured</th><th>simulated</th></tr>\n",
        c.printed->parameter, c.printed->value, c.printed->low, c.printed->high);
    for (const PrintedOutcome& o : c.printed->samples)
        html +=
            fmt::format("<tr><td>{}</td><td class=\"n\">{:.4g} mm</td><td class=\"n\">{:.4g} mm</td></tr>\n",
                        html_escaped(to_string(o.sample.place)), o.sample.radius_mm, o.simulated_radius_mm);
    return html + "</table>\n";
}

std::string files(const Calibration& c) {
    std::string html = "<h2>Files</h2>\n<ul>\n";
    for (const CalibratedSet& set : c.sets) {
        for (const TensionCurve& test : set.tests) {
            html += "<li>" + html_escaped(test.record.file) + "<br><small>";
            for (const std::string& column : test.record.columns) html += html_escaped(column) + "; ";
            html += fmt::format("{} rows, {} of {} fitted</small></li>\n", test.record.size(),
                                test.used_cycles(), test.cycles.size());
        }
    }
    return html + "</ul>\n";
}

}  // namespace

std::string calibration_page(const Calibration& c) {
    std::string html;
    if (!c.card.description.empty()) html += html_paragraph(c.card.description);
    if (!c.warnings.empty()) {
        html += "<ul class=\"warnings\">\n";
        for (const std::string& warning : c.warnings) html += "<li>" + html_escaped(warning) + "</li>\n";
        html += "</ul>\n";
    }
    html += values(c);
    for (const CalibratedSet& set : c.sets) {
        const std::string at = fmt::format("Fabric at a pre-stretch of {:g}", set.prestretch);
        html += fmt::format("<h2>{}: the law</h2>\n{}<div class=\"plots\">\n{}</div>\n", at,
                            fit_text(set, c.campaign.options.mode), law_plots(set));
        html += section(
            at + ": the tests",
            "Every recorded row; green is what the law is fitted to: the last cycle, and those before "
            "it that noise alone tells from it.",
            cycle_plots(set));
    }
    html += section("Shear", "Lines are drawn over the range that counts as linear.", shear_plots(c));
    html += section("Bending", "A strip that hangs over by L; the curve is that of every elastic strip.",
                    bending_plots(c));
    html += section("Plastic", "Young's modulus is the tangent at zero.", plastic_plots(c));
    html += printed(c);
    html += files(c);
    return html_page("Calibration of " + c.card.name, html);
}

}  // namespace ruche
