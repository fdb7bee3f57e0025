// Pictures of the ground from a tile server: a layer of Leaflet in the mission frame, on which each picture of web
// mercator is laid at its place.

const { L } = window;
const SIDE = 256, KEPT = 400, OVER = 1 + 1 / 256; // neighbours overlap by a pixel, pictures and tiles: no seams
const FARTHEST = -30; // zoom of the layer, of which 0 is a pixel to a metre; the server says how far out there are pictures

// what is no markup of its own
const plain = text => text.replace(/[&<>"]/g, one => `&#${one.charCodeAt(0)};`);

export const FrameTiles = L.GridLayer.extend({
  // frame: whose origin the map has; attribution: what is said of the pictures
  initialize(frame, attribution) {
    L.GridLayer.prototype.initialize.call(this, { tileSize: SIDE, minZoom: FARTHEST, attribution: plain(attribution) });
    Object.assign(this, { frame, images: new Map(), wrong: "" });
    this.on("tileerror", ({ error }) => this.say(plain(`no tiles: ${error.message}`)));
    this.on("tileload", () => this.say(""));
    this.on("tileloadstart", ({ tile }) => Object.assign(tile.style, { width: `${SIDE * OVER}px`, height: `${SIDE * OVER}px` }));
  },

  onAdd(map) {
    this.told = L.control.attribution({ prefix: false }).addTo(map);
    L.GridLayer.prototype.onAdd.call(this, map);
  },

  onRemove(map) {
    L.GridLayer.prototype.onRemove.call(this, map);
    this.told.remove();
  },

  // what is wrong, beside the attribution
  say(wrong) {
    if (wrong === this.wrong) return;
    if (this.wrong) this.told.removeAttribution(this.wrong);
    this.told.addAttribution(wrong);
    this.told.getContainer().classList.toggle("wrong", Boolean(wrong));
    this.wrong = wrong;
  },

  // what is there stays until what takes its place is there
  getEvents() {
    const { viewprereset, ...events } = L.GridLayer.prototype.getEvents.call(this);
    return events;
  },

  createTile(coords, done) {
    const canvas = L.DomUtil.create("canvas", "tile"), ratio = window.devicePixelRatio || 1;
    Object.assign(canvas, { width: SIDE * OVER * ratio, height: SIDE * OVER * ratio });
    this.draw(canvas, coords, ratio).then(() => done(null, canvas), error => done(error, canvas));
    return canvas;
  },

  async draw(canvas, coords, ratio) {
    const { frame } = this, corner = coords.scaleBy(L.point(SIDE, SIDE)), pen = canvas.getContext("2d");
    const at = this._map.unproject(corner, coords.z), scale = this._map.options.crs.scale(coords.z) * ratio, size = SIDE * OVER * ratio / scale;
    const query = new URLSearchParams({ latitude: frame.latitude_deg, longitude: frame.longitude_deg, north: at.lat - size / 2, east: at.lng + size / 2, height: size, width: size, pixels_per_m: scale });
    const response = await fetch(`/tiles.json?${query}`), told = await response.json();
    if (!response.ok) throw new Error(told.error);
    const xy = ([north, east]) => [(east - at.lng) * scale, (at.lat - north) * scale];
    const drawn = told.tiles.map(async ({ url, corners }) => {
      const image = await this.image(url), [[x, y], [rightX, rightY], [downX, downY]] = corners.map(xy);
      if (!image) return;
      pen.setTransform(rightX - x, rightY - y, downX - x, downY - y, x, y);
      pen.drawImage(image, 0, 0, OVER, OVER);
    });
    if (drawn.length) await Promise.race(drawn); // the others follow
  },

  // a picture, asked for once while it is among those that were used last; null where there is none
  image(url) {
    const found = this.images.get(url) ?? loaded(url);
    this.images.delete(url);
    this.images.set(url, found);
    for (const old of [...this.images.keys()].slice(0, Math.max(0, this.images.size - KEPT))) this.images.delete(old);
    return found;
  },
});

async function loaded(url) {
  const image = new Image();
  image.src = url;
  try { await image.decode(); } catch { return null; }
  return image;
}
