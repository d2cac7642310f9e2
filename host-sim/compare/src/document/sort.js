// Headings become buttons that sort their table; rows without a number stay at the end.
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  const headings = [...table.querySelectorAll("th[data-sort]")];
  headings.forEach((heading, column) => {
    const text = heading.dataset.sort === "text";
    const key = (row) => {
      const cell = row.cells[column];
      if (text) return cell.textContent;
      const value = cell && cell.dataset.value;
      return value === undefined ? NaN : value === "inf" ? Infinity : Number(value);
    };
    const button = document.createElement("button");
    button.type = "button";
    button.append(...heading.childNodes);
    heading.append(button);
    button.addEventListener("click", () => {
      const down = heading.getAttribute("aria-sort") === "ascending";
      headings.forEach((other) => other.removeAttribute("aria-sort"));
      heading.setAttribute("aria-sort", down ? "descending" : "ascending");
      const sign = down ? -1 : 1;
      const rows = [...body.rows].map((row) => ({ row, key: key(row) }));
      rows.sort((a, b) => {
        if (text) return sign * a.key.localeCompare(b.key);
        if (Number.isNaN(a.key) || Number.isNaN(b.key)) return Number.isNaN(a.key) - Number.isNaN(b.key);
        return a.key === b.key ? 0 : sign * (a.key < b.key ? -1 : 1);
      });
      body.append(...rows.map(({ row }) => row));
    });
  });
}
