// The process algebra as it is typed: in colours, with the place of an error, and as a tree.

const by = id => document.getElementById(id);
const KINDS = [["operator", /^[.~|+](?=\s*\()/], ["task", /^p\d+/], ["timing", /^[_-]\[[^\]]*\]?/], ["", /^[\s\S]/]];

function span(name, text) {
  const found = document.createElement("span");
  found.className = name;
  found.textContent = text;
  return found;
}

// the pieces of a text, each with what it is
export function pieces(text) {
  const found = [];
  for (let at = 0; at < text.length;) {
    const [name, pattern] = KINDS.find(([, one]) => one.test(text.slice(at)));
    const piece = pattern.exec(text.slice(at))[0];
    found.push([name, piece, at]);
    at += piece.length;
  }
  return found;
}

function tree(node) {
  const item = document.createElement("li");
  item.append(span(node.parts.length ? "operator" : "task", node.text), span("timing", node.suffix && ` ${node.suffix}`));
  if (node.parts.length) {
    const list = document.createElement("ul");
    list.append(...node.parts.map(tree));
    item.append(list);
  }
  return item;
}

export function show(text, told) {
  const { error } = told, shown = by("relations-shown");
  // an error at the end is shown as a blank there
  const whole = error && error.offset >= text.length ? `${text} ` : text;
  shown.replaceChildren(...pieces(whole).flatMap(([name, piece, at]) => {
    const k = error ? [...text].slice(0, error.offset).join("").length - at : -1;
    if (k < 0 || k >= piece.length) return [span(name, piece)];
    return [span(name, piece.slice(0, k)), span("fault", piece.slice(k, k + 1)), span(name, piece.slice(k + 1))];
  }));
  by("relations-error").textContent = error ? `${error.caret ? `${error.caret}\n` : ""}${error.error}${error.expected ? `; expected ${error.expected}` : ""}${error.got ? `; got ${error.got}` : ""}` : "";
  by("relations").setAttribute("aria-invalid", String(Boolean(error)));
  const list = document.createElement("ul");
  if (told.tree) list.append(tree(told.tree));
  by("relations-tree").replaceChildren(list);
  by("relations-rows").replaceChildren(...(told.rows || []).map(row => {
    const item = document.createElement("li");
    item.textContent = row;
    return item;
  }));
}
