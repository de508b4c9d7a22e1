// SPDX-License-Identifier: MIT
// The panel: switches of what the file holds, the exposure, and the keys of the canvas. Texts of the
// scene are set as text, never as HTML.

import { largestStrength } from 'alpenglow/layers.js';

const element = (id) => document.getElementById(id);

function addSwitch(key, label, hint, { state, changed }) {
  const line = document.createElement('label');
  const box = document.createElement('input');
  box.type = 'checkbox';
  box.id = `switch-${key}`;
  box.checked = state[key];
  box.addEventListener('change', () => {
    state[key] = box.checked;
    changed(key);
  });
  line.append(box, label);
  if (hint !== '') {
    const small = document.createElement('small');
    small.textContent = hint;
    line.append(small);
  }
  element('switches').append(line);
}

function addSwitches({ found, state }, changed) {
  const given = { state, changed };
  if (found.light === 'map' || found.light === 'radiance') addSwitch('light', 'Light', 'off: even light from all sides', given);
  if (found.light === 'emission') addSwitch('light', 'Light', 'off: white surfaces; the file holds light in place of colours', given);
  if (found.occlusion) addSwitch('occlusion', 'Occlusion', found.light === 'map' ? 'darkens the light maps too' : '', given);
  if (found.textures && found.light !== 'emission') addSwitch('colours', 'Colours', '', given);
}

/// A slider for each light.
function addDimmers({ layers, dim, request }) {
  layers.forEach((layer, i) => {
    const line = document.createElement('label');
    line.className = 'slider';
    const value = document.createElement('output');
    const slider = document.createElement('input');
    Object.assign(slider, { type: 'range', min: 0, max: 100 * largestStrength, step: 1, value: 100, id: `dimmer-${i}` });
    line.htmlFor = slider.id; // an output could be labelled too
    value.textContent = '100 %';
    slider.addEventListener('input', () => {
      value.textContent = `${slider.value} %`;
      dim(i, slider.value / 100);
      request();
    });
    line.append(layer.name, value, slider);
    element('dimmers').append(line);
  });
}

const metres = (value) => `${Number(value.toPrecision(3))} m`;

/// A place to a hundredth of a cell, or better.
const placeText = (place, cell) => `${Number(place.toFixed(Math.min(Math.max(2 - Math.floor(Math.log10(cell)), 0), 20)))} m`;

/// A slider for each axis of the sphere's place; they follow when it is dragged.
function addPlaces({ sphere }) {
  if (sphere === null) return;
  const sliders = ['x', 'y', 'z'].map((axis) => {
    const line = document.createElement('label');
    line.className = 'slider';
    const value = document.createElement('output');
    const slider = document.createElement('input');
    const range = { min: sphere.bounds.low[axis], max: sphere.bounds.high[axis] };
    Object.assign(slider, { type: 'range', id: `sphere-${axis}`, step: (range.max - range.min) / 200 || 1, ...range });
    slider.addEventListener('input', () => {
      const point = sphere.position.clone();
      point[axis] = Number(slider.value);
      sphere.place(point);
      follow();
    });
    line.htmlFor = slider.id; // an output could be labelled too
    line.append(`Sphere ${axis}`, value, slider);
    element('places').append(line);
    return { axis, slider, value };
  });
  const follow = () => sliders.forEach(({ axis, slider, value }) => {
    slider.value = sphere.position[axis];
    value.textContent = placeText(sphere.position[axis], slider.step);
  });
  document.addEventListener('pointermove', follow);
  sphere.place(sphere.start);
  follow();
}

/// Says that a slice has an exposure of its own.
const shiftText = (shift) => (shift === 0 ? '' : `, shown ${Math.abs(shift).toFixed(2)} EV ${shift < 0 ? 'darker' : 'brighter'} than the page`);

/// The switch of the slice, its grid if there are several, its axis, and its place.
function addSlices({ slices, state, show, measure }) {
  if (slices === null) return;
  const [grid, axis, place, value] = ['slice-grid', 'slice-axis', 'slice-place', 'slice-value'].map(element);
  slices.grids.forEach(({ cell }, i) => grid.add(new Option(`cells of ${metres(cell)}`, i)));
  element('slice-grid-line').hidden = slices.grids.length < 2;
  const draw = () => {
    const found = slices.show(Number(grid.value), Number(axis.value), Number(place.value));
    value.textContent = `${placeText(found.place, slices.grids[Number(grid.value)].cell)}, up to ${Number(found.brightest.toPrecision(3))} W/m²${shiftText(found.shift)}`;
    place.setAttribute('aria-valuetext', value.textContent);
  };
  const start = () => {
    const [min, max] = slices.range(Number(grid.value), Number(axis.value));
    Object.assign(place, { min, max, value: Math.round((min + max) / 2) });
    draw();
  };
  addSwitch('slices', 'Slice of light in space', 'mean radiance of each cell, with the light', { state, changed: () => {
    element('slice').hidden = !state.slices;
    show();
  } });
  grid.addEventListener('change', start);
  axis.addEventListener('change', start);
  place.addEventListener('input', draw);
  axis.value = slices.axis;
  slices.expose(measure());
  start();
}

/// Eight bits of MOZ_lightmap differ from the sum of the lights by some 5 %, another bake by far more.
const allowedApart = 0.3;

function notesOf({ found, apart }) {
  const amount = apart > 2 ? 'more than 200' : Math.round(100 * apart);
  if (apart > allowedApart) return `The dimmers hold light of another bake: together they differ from this one by ${amount} %.`;
  return found.occlusion || found.light !== null ? '' : 'This file holds no baked map. It is shown in plain light.';
}

function addKeys(view, request) {
  const step = 0.1;
  const keys = {
    ArrowLeft: () => view.turn(-step, 0),
    ArrowRight: () => view.turn(step, 0),
    ArrowUp: () => view.turn(0, -step),
    ArrowDown: () => view.turn(0, step),
    '+': () => view.dolly(0.9),
    '=': () => view.dolly(0.9),
    '-': () => view.dolly(1 / 0.9),
    r: () => view.reset(),
  };
  element('view').addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || keys[event.key] === undefined) return;
    event.preventDefault();
    keys[event.key]();
    request();
  });
}

export function buildPanel(page) {
  const { name, state, show, film, view, request, measure } = page;
  const slider = element('exposure');
  const values = new Map(); // exposure with the light, and without
  const expose = (value) => {
    values.set(state.light, value);
    slider.value = value;
    element('exposure-value').textContent = `${value >= 0 ? '+' : '−'}${Math.abs(value).toFixed(2)} EV`;
    film(value);
  };
  const automatic = () => {
    const value = Math.round(20 * measure()) / 20;
    slider.min = Math.min(slider.min, value - 6);
    slider.max = Math.max(slider.max, value + 6);
    expose(value);
  };
  const changed = () => {
    show();
    if (values.has(state.light)) expose(values.get(state.light));
    else automatic();
  };
  document.title = `${name} – Alpenglow`;
  element('name').textContent = name;
  element('notes').textContent = notesOf(page);
  element('licence').textContent = element('licence-text').textContent.trim();
  addSwitches(page, changed);
  addDimmers(page);
  addPlaces(page);
  addSlices(page);
  slider.addEventListener('input', () => expose(Number(slider.value)));
  element('auto').addEventListener('click', automatic);
  element('reset').addEventListener('click', () => {
    view.reset();
    request();
  });
  addKeys(view, request);
  automatic();
  element('panel').hidden = false;
}
