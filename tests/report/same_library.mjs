// Are the files under third_party/uplot those of the npm package, byte by byte?
// usage: node same_library.mjs THIRD_PARTY_FOLDER
import {readFileSync} from 'node:fs';
import {join} from 'node:path';

const ours = process.argv[2];
for (const [mine, theirs] of [['uPlot.iife.min.js', 'dist/uPlot.iife.min.js'], ['uPlot.min.css', 'dist/uPlot.min.css'],
                              ['LICENSE', 'LICENSE']]) {
  if (!readFileSync(join(ours, mine)).equals(readFileSync(new URL(`node_modules/uplot/${theirs}`, import.meta.url)))) {
    console.error(`${mine} differs from the package's ${theirs}`);
    process.exit(1);
  }
}
