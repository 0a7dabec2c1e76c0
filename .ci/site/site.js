// What can be scrolled can be reached by the keyboard; what cannot is no stop on the way.
function reach() {
  for (const each of document.querySelectorAll("pre, .formula, .table-wrapper, .panels, .highlight")) {
    if (each.scrollWidth > each.clientWidth) each.tabIndex = 0;
    else each.removeAttribute("tabindex");
  }
}
addEventListener("load", reach);
addEventListener("resize", reach);
