// SPDX-License-Identifier: MIT
// node compare.mjs FOLDER: shows what write_scene left there and holds every pixel to albedo · E/π.
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import { openViewer } from './viewer.mjs';

const decode = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
const encode = (l) => (l <= 0.0031308 ? 12.92 * l : 1.055 * l ** (1 / 2.4) - 0.055);
/// A colour as three.js' files hold it, in eight bits of sRGB.
const inEightBits = (l) => decode(Math.round(255 * encode(l)) / 255);

/// Three halves of a step of eight bits of sRGB, times what the texture is multiplied by: half a step
/// of rounding, and one of noise.
const ditheredStep = (value, strength) => {
  const c = encode(Math.min(1, value / strength));
  return strength * (decode(c + 1.5 / 255) - decode(c));
};

/// By name of a .glb's materials, what their textures are relative to.
async function emissiveStrengths(file) {
  const bytes = await readFile(file);
  const json = JSON.parse(bytes.toString('utf8', 20, 20 + bytes.readUInt32LE(12)));
  const strengths = {};
  for (const m of json.materials ?? []) {
    const strength = m.extensions?.KHR_materials_emissive_strength?.emissiveStrength ?? 1;
    strengths[m.name] = Math.max(strengths[m.name] ?? 0, strength);
  }
  return strengths;
}

/// What a pixel should be, and how far it may be from it.
///
/// Both: a rasteriser snaps vertices to 1/16 pixel (drift); a texture unit's weights have eight
/// bits, so a value may be off by 1/256 of how far the four texels lie apart, in either direction
/// (spread); and single floats on the way, 1e-5.
/// three.js: half floats, 2⁻¹¹. Babylon.js: eight bits of the texel's largest channel, half a step
/// of 2⁻⁸, for any of the four texels. glTF with the light as emission, whose texture holds
/// albedo · E/π in eight bits of sRGB, dithered: three halves of a step at the largest of the four
/// texels.
const kinds = {
  three: {
    file: 'cornell.json',
    albedo: inEightBits,
    emission: (e, k) => inEightBits(e[k] / Math.max(...e, 1e-30)) * Math.max(...e),
    stored: (pixel, k) => (pixel.albedo[k] / Math.PI) * pixel.irradiance[k] * 2 ** -11,
  },
  babylon: {
    file: 'cornell.babylon',
    albedo: (a) => a,
    emission: (e, k) => e[k],
    stored: (pixel, k) =>
      (pixel.albedo[k] / Math.PI) * Math.max(...pixel.irradiance.map((e, i) => e + pixel.spread[i])) * 2 ** -8,
  },
  glb: {
    file: 'cornell.glb',
    albedo: (a) => a,
    emission: (e, k) => e[k],
    stored: (pixel, k, strength) =>
      ditheredStep((pixel.albedo[k] / Math.PI) * (pixel.irradiance[k] + pixel.spread[k]) + pixel.emission[k], strength),
  },
};

function compare(kind, expected, shown, strengths) {
  const sums = { error: 0, exact: 0, value: 0, worst: 0, worstShare: 0, faults: [] };
  for (const pixel of expected.pixels) {
    for (let k = 0; k < 3; k++) {
      const scale = kind.albedo(pixel.albedo[k]) / Math.PI;
      const wanted = scale * pixel.irradiance[k] + kind.emission(pixel.emission, k);
      const exact = (pixel.albedo[k] / Math.PI) * pixel.irradiance[k] + pixel.emission[k];
      const got = shown.pixels[4 * (pixel.y * expected.side + pixel.x) + k];
      const moved = scale * ((2 * pixel.spread[k]) / 256 + pixel.drift[k]);
      const allowed = kind.stored(pixel, k, strengths[pixel.material]) + moved + 1e-5 * wanted;
      const error = Math.abs(got - wanted);
      sums.error += (got - wanted) ** 2;
      sums.exact += (got - exact) ** 2;
      sums.value += wanted;
      sums.worst = Math.max(sums.worst, error / wanted);
      sums.worstShare = Math.max(sums.worstShare, error / allowed);
      if (!(error <= allowed)) {
        sums.faults.push(`pixel ${pixel.x}, ${pixel.y} (${pixel.surface}), channel ${k}: ${got}, not ${wanted} ± ${allowed}`);
      }
    }
  }
  return sums;
}

const folder = process.argv[2];
const expected = JSON.parse(await readFile(path.join(folder, 'expected.json'), 'utf8'));
const viewer = await openViewer();
let failed = expected.pixels.length < 1000;
for (const [name, kind] of Object.entries(kinds)) {
  const file = path.join(folder, kind.file);
  const shown = await viewer.show(name, file, expected.side, expected.camera);
  const sums = compare(kind, expected, shown, name === 'glb' ? await emissiveStrengths(file) : {});
  const count = 3 * expected.pixels.length;
  const mean = sums.value / count;
  console.log(
    `${name}: ${expected.pixels.length} pixels; relative RMSE ${(Math.sqrt(sums.error / count) / mean).toExponential(2)}, ` +
      `with the scene's own colours ${(Math.sqrt(sums.exact / count) / mean).toExponential(2)}; largest relative error ` +
      `${sums.worst.toExponential(2)}, ${sums.worstShare.toFixed(2)} of what is allowed; ${shown.seconds.toFixed(1)} s`,
  );
  for (const fault of [...shown.faults, ...sums.faults.slice(0, 8)]) console.log(`  ${fault}`);
  failed ||= sums.faults.length > 0 || shown.faults.length > 0;
}
await viewer.close();
process.exit(failed ? 1 : 0);
