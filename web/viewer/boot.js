// SPDX-License-Identifier: MIT
// Makes modules of the texts in the page. A page from the disk may not fetch files, but it may import
// blobs; an import map gives them their names. This script is no module and runs before all of them.
(function boot() {
  const texts = [...document.querySelectorAll('script.module')];
  const origin = 'http://page.invalid/'; // no address: names are resolved against it
  const relative = /\b(from|import)(\s*)(['"])(\.\.?\/[^'"]+)\3/g;
  const absolute = (name, from) => new URL(name, origin + from).pathname.slice(1);
  const imports = {};
  for (const text of texts) {
    const { name } = text.dataset;
    const at = name === 'three' ? 'three/build/three.module.js' : name;
    const source = text.textContent
      .replace(relative, (all, word, space, quote, path) => `${word}${space}${quote}${absolute(path, at)}${quote}`)
      .replaceAll('import.meta.url', `'${origin}'`); // KTX2Loader names a transcoder, which the page never loads
    imports[name] = URL.createObjectURL(new Blob([source], { type: 'text/javascript' }));
  }
  const map = document.createElement('script');
  map.type = 'importmap';
  map.textContent = JSON.stringify({ imports });
  document.head.append(map);
  const main = document.createElement('script');
  main.type = 'module';
  main.textContent = "import 'alpenglow/main.js';";
  document.head.append(main);
})();
