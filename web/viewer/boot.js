// SPDX-License-Identifier: MIT
// Makes modules of the texts in the page. A page from the disk may not fetch files, but it may import
// blobs; an import map gives them their names. This script is no module and runs before all of them. Its
// words are old ones, so that an old browser reads it and shows the message.
(function boot() {
  const stop = (text) => {
    document.getElementById('message').textContent = text;
  };
  if (!HTMLScriptElement.supports || !HTMLScriptElement.supports('importmap')) {
    stop('This browser is too old for the scene: it has no import maps. Open the page in a browser of 2023 or later.');
    return;
  }
  const texts = [...document.querySelectorAll('script.module')];
  const origin = 'http://page.invalid/'; // no address: names are resolved against it
  const relative = /\b(from|import)(\s*)(['"])(\.\.?\/[^'"]+)\3/g;
  const absolute = (name, from) => new URL(name, origin + from).pathname.slice(1);
  const imports = {};
  const failed = (event) => {
    if (document.documentElement.dataset.ready) return;
    stop(`The scripts of the page could not be started${event.message ? ` (${event.message})` : ''}. Write the page again by alpenglow web, or open it in another browser.`);
  };
  addEventListener('error', failed, true); // of elements too, which do not bubble
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
