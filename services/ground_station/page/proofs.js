// From a verdict to its proofs: kernel, theorem, what both solvers said, mutants, definition. All text is set as text.

const by = id => document.getElementById(id);

function made(tag, text = "", classes = "") {
  const one = Object.assign(document.createElement(tag), { textContent: text });
  if (classes) one.className = classes;
  return one;
}

// picked: places of the parts in the verdicts' details
export function show(recording, title, picked) {
  const { proofs, details } = recording.verdicts;
  by("proofs-title").textContent = title;
  by("proofs-note").textContent = `Chains, theorems and ${proofs.solvers[0]} as report.json says: ${proofs.line}. ${proofs.solvers[1] || "A second solver"} and mutants as the product records them${proofs.same_ledger ? "" : "; its ledger is no longer the one of this report"}.`;
  by("proofs-note").className = proofs.same_ledger ? "soft" : "unknown";
  by("proofs-parts").replaceChildren(...picked.map(k => part(proofs, details[k], proofs.rows[k], picked.length === 1)));
  by("proofs").showModal();
  by("proofs").scrollTop = 0;
}

function part(proofs, said, row, open) {
  const box = made("details"), head = made("summary");
  box.open = open;
  head.append(made("span", `${said.item}: `), made("b", said.verdict, said.verdict));
  box.append(head);
  if (said.note) box.append(made("p", said.note, "soft"));
  box.append(...row.chains.map(chain => link(proofs, chain)));
  if (row.undecided) box.append(made("p", "Undecided: nothing was observed that a kernel could judge.", "unknown"));
  box.append(...row.missing.map(text => made("p", `Missing: ${text}.`, "violated")));
  return box;
}

function link(proofs, chain) {
  const box = made("section", "", "chain"), head = made("p"), inside = chain.by ? `, in ${proofs.names[chain.by] ?? chain.by}` : "";
  const kernel = made("code", proofs.names[chain.kernel] ?? chain.kernel);
  kernel.title = chain.kernel;
  head.append("Kernel ", kernel, `${inside}: ${chain.calls ? `${chain.calls} calls` : "compiled into what was called"}; `, made("b", chain.status || "not in the report"), `; ${mutants(proofs.mutants[chain.kernel])}.`);
  box.append(head, ...chain.theorems.map(name => theorem(proofs, name)));
  if (chain.definition) {
    const line = made("p");
    line.append("Definition ", made("code", chain.definition), ` in ${chain.file || "no file"}${chain.restates ? `, restated: ${chain.restates}` : ""}.`);
    box.append(line);
  }
  return box;
}

function theorem(proofs, name, kind = "Theorem") {
  const one = proofs.theorems[name], box = made("div", "", "theorem");
  if (!one) {
    box.append(made("p", `${kind} ${name}: the report does not have it.`, "violated"));
    return box;
  }
  const head = made("p");
  head.append(`${kind} `, made("code", name), ": ", made("b", one.sentence));
  box.append(head, made("p", `${solvers(proofs, one)}${one.premises ? `; premises ${one.premises}` : ""}.`, one.status === "proved" ? "holds" : "violated"));
  if (one.statement) {
    const stated = made("details");
    stated.append(made("summary", "as it was stated"), made("p", one.statement, "soft"));
    box.append(stated);
  }
  for (const text of one.assumptions ?? []) box.append(made("p", `Assumes: ${text}`, "unknown"));
  if (one.lemmas?.length) {
    const rest = made("details");
    rest.className = "lemmas";
    rest.append(made("summary", `rests on ${one.lemmas.length} lemma${one.lemmas.length > 1 ? "s" : ""}`));
    // made when it is looked at: lemmas rest on lemmas
    rest.addEventListener("toggle", () => { if (rest.children.length === 1) rest.append(...one.lemmas.map(lemma => theorem(proofs, lemma, "Lemma"))); });
    box.append(rest);
  }
  return box;
}

function solvers(proofs, one) {
  const [first, second] = proofs.solvers, answers = Object.entries(one.cvc5).map(([answer, n]) => `${n} ${answer}`);
  return `${first}: ${one.status}, ${one.obligations} obligations; ${second || "second solver"}: ${answers.join(", ") || "not asked"}`;
}

function mutants(counts) {
  if (!counts) return "no mutants on record";
  const shown = Object.entries(counts).filter(([, n]) => n).map(([verdict, n]) => `${n} ${verdict}`);
  return `mutants on record: ${shown.join(", ") || "none to make"}`;
}
