// Bundles the pages, each into one HTML file: report.html with a mark where the program puts a result's data, and the
// studio's.
//   node build.mjs OUT.cpp          both as strings of the program
//   node build.mjs report OUT.html  one of them, to look at
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const pages = {
    report: { script: "main.ts", frame: "index.html", function: "page_template" },
    studio: { script: "studio/main.ts", frame: "studio/index.html", function: "studio_page" },
};

/** A page as a string of a C++ program; in pieces, because compilers limit the length of one. */
function source(name, text) {
    const pieces = [];
    for (let i = 0; i < text.length; i += 8000) pieces.push(`R"ruche~(${text.slice(i, i + 8000)})ruche~"`);
    return `
std::string_view ruche::${name}() {
    static constexpr char page[] =
${pieces.join("\n")};
    return {page, sizeof page - 1};
}
`;
}

async function bundled({ script, frame }) {
    const bundle = await build({
        entryPoints: [join(here, "src", script)],
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
    const safe = text(".js").replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
    return (await readFile(join(here, "src", frame), "utf8"))
        .replace("/*STYLE*/", () => text(".css"))
        .replace("/*SCRIPT*/", () => safe);
}

const [first, second] = process.argv.slice(2);
if (second) {
    await mkdir(dirname(second), { recursive: true });
    await writeFile(second, await bundled(pages[first]));
} else {
    const parts = await Promise.all(Object.values(pages).map(async (page) => source(page.function, await bundled(page))));
    await writeFile(first, `#include "ruche/output/page_template.hpp"\n${parts.join("")}`);
}
