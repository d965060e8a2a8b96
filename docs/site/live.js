// Without scripts the pictures of a tutorial stand alone.
for (const place of document.querySelectorAll(".live")) {
  const frame = document.createElement("iframe");
  frame.loading = "lazy";
  frame.title = "The page, with the system of this tutorial";
  frame.src = place.dataset.page;
  place.append(frame);
}
