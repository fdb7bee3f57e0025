// Pictures of the ground from a tile server, each laid on its place of the mission frame.

import { color } from "./canvas.js";

const SETTLED_MS = 120, KEPT = 400, OVER = 1 + 1 / 256; // neighbours overlap by a pixel: no seams

export class Tiles {
  // drawn: draws the map anew; attribution: what is said of the pictures
  constructor(frame, attribution, drawn) {
    Object.assign(this, { frame, attribution, drawn, asked: "", wrong: "", shown: [], images: new Map(), later: 0 });
  }

  // all that is there of a view; what is not yet there is asked for once the view stays
  draw(map, height) {
    const { view, width, pen } = map, ratio = window.devicePixelRatio || 1;
    this.want({ latitude: this.frame.latitude_deg, longitude: this.frame.longitude_deg, north: view.north, east: view.east, height: height / view.scale, width: width / view.scale, pixels_per_m: view.scale * ratio });
    for (const { url, corners } of this.shown) {
      const image = this.images.get(url);
      if (!image?.complete || !image.naturalWidth) continue;
      const [[x, y], [rightX, rightY], [downX, downY]] = corners.map(corner => map.xy(...corner));
      pen.save();
      pen.transform(rightX - x, rightY - y, downX - x, downY - y, x, y);
      pen.drawImage(image, 0, 0, OVER, OVER);
      pen.restore();
    }
    const said = this.wrong || this.attribution;
    if (said) map.label(said, Math.max(2, width - pen.measureText(said).width - 8), height - 30, color(this.wrong ? "bad" : "ink"));
  }

  want(view) {
    const query = new URLSearchParams(view).toString();
    if (query === this.asked) return;
    this.asked = query;
    clearTimeout(this.later);
    this.later = setTimeout(() => this.ask(query), this.shown.length ? SETTLED_MS : 0);
  }

  async ask(query) {
    let told;
    try {
      const response = await fetch(`/tiles.json?${query}`);
      told = await response.json();
      if (!response.ok) throw new Error(told.error);
    } catch (error) {
      Object.assign(this, { wrong: `no tiles: ${error.message}`, shown: [] });
      this.drawn();
      return;
    }
    if (query !== this.asked) return; // the view is another one already
    Object.assign(this, { wrong: "", shown: told.tiles });
    for (const { url } of this.shown) this.keep(url);
    // those that were not looked at for the longest time go
    for (const url of [...this.images.keys()].slice(0, Math.max(0, this.images.size - KEPT))) this.images.delete(url);
    this.drawn();
  }

  // a picture, loaded once; as the newest of all
  keep(url) {
    const image = this.images.get(url) ?? this.load(url);
    this.images.delete(url);
    this.images.set(url, image);
  }

  load(url) {
    const image = new Image();
    image.addEventListener("load", () => this.drawn());
    image.src = url;
    return image;
  }
}
