#include "ruche/study/html_page.hpp"

#include "ruche/study/calibration/plot.hpp"

namespace ruche {

namespace {

constexpr std::string_view page_style = R"(<style>
body { font: 15px/1.5 system-ui, sans-serif; color: #1a1a1a; max-width: 1120px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; } h2 { font-size: 1.25em; margin-top: 2em; border-bottom: 1px solid #ccc; }
table { border-collapse: collapse; } th, td { text-align: left; padding: .25em .8em .25em 0; vertical-align: top;
border-bottom: 1px solid #e5e5e5; } td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.bad { color: #a33c00; } ul.warnings { background: #fff6e5; border-left: 4px solid #e69f00; padding: .6em 2em; }
svg text { font: 11px system-ui, sans-serif; fill: #333; } svg text.title { font-weight: 600; font-size: 13px; }
svg .grid { stroke: #e3e3e3; } .plots { display: flex; flex-wrap: wrap; gap: 8px; }
small { color: #666; } code { font-size: 12px; } details { margin: .6em 0; } .good { color: #1b6e3c; } .open { color: #7a5c00; }
img { max-width: 100%; } table.wide { font-size: 13px; }
</style>
)";

}  // namespace

std::string html_page(const std::string& title, const std::string& body) {
    const std::string escaped = html_escaped(title);
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + escaped +
           "</title>\n" + std::string(page_style) + "</head><body>\n<h1>" + escaped + "</h1>\n" + body +
           "</body></html>\n";
}

std::string html_paragraph(const std::string& text) { return "<p>" + html_escaped(text) + "</p>\n"; }

}  // namespace ruche
