// Bundles the page into one HTML file with a mark where the program puts a result's data.
//   node build.mjs OUT.html|OUT.cpp
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, "dist", "report.html");

/** The page as a string of a C++ program; in pieces, because compilers limit the length of one. */
function source(text) {
    const pieces = [];
    for (let i = 0; i < text.length; i += 8000) pieces.push(`R"ruche~(${text.slice(i, i + 8000)})ruche~"`);
    return `#include "ruche/output/page_template.hpp"

std::string_view ruche::page_template() {
    static constexpr char page[] =
${pieces.join("\n")};
    return {page, sizeof page - 1};
}
`;
}

const bundle = await build({
    entryPoints: [join(here, "src", "main.ts")],
    bundle: true,
    minify: true,
    format: "iife",
    target: "es2022",
    legalComments: "inline",
    write: false,
    outdir: "out",
    logLevel: "warning",
});
const text = (ending) => bundle.outputFiles.find((f) => f.path.endsWith(ending)).text;
// Inside a script element only its end tag means something; inside the bundle that can only be part of a string.
const script = text(".js").replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
const page = (await readFile(join(here, "src", "index.html"), "utf8"))
    .replace("/*STYLE*/", () => text(".css"))
    .replace("/*SCRIPT*/", () => script);
await mkdir(dirname(out), { recursive: true });
await writeFile(out, out.endsWith(".cpp") ? source(page) : page);
