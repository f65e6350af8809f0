"""The licenses of what is linked into the wheel: every crate has its text, and none is missing unnoticed."""

import notices
import pytest


def crate(folder, license_="MIT", authors=("Ada Lovelace <ada@example.org>",), name="made"):
    """A crate whose sources are in a folder."""
    return {
        "name": name,
        "version": "1.0.0",
        "license": license_,
        "authors": list(authors),
        "repository": "https://example.org/made",
        "manifest_path": str(folder / "Cargo.toml"),
    }


def test_own_text_goes_along_with_notices_and_without_the_license_not_chosen(tmp_path):
    for name, text in (("LICENSE-MIT", "mit of made"), ("LICENSE-APACHE", "apache"), ("NOTICE", "notice")):
        (tmp_path / name).write_text(text, encoding="utf-8")
    assert notices.texts(crate(tmp_path, "MIT OR Apache-2.0"), []) == ["mit of made", "notice"]
    assert notices.texts(crate(tmp_path, "Apache-2.0"), []) == ["apache", "mit of made", "notice"]


def test_standard_text_names_the_authors(tmp_path):
    (text,) = notices.texts(crate(tmp_path), [])
    assert "Copyright (c) Ada Lovelace\n" in text
    assert "THE SOFTWARE IS PROVIDED" in text


def test_authors_of_the_same_repository_stand_in(tmp_path):
    (text,) = notices.texts(crate(tmp_path, authors=()), [crate(tmp_path, name="sibling")])
    assert "Copyright (c) Ada Lovelace\n" in text


@pytest.mark.parametrize(("license_", "authors"), [("Apache-2.0", ("Ada",)), ("MIT", ()), (None, ("Ada",))])
def test_missing_text_stops(tmp_path, license_, authors):
    with pytest.raises(SystemExit, match=r"made 1\.0\.0"):
        notices.texts(crate(tmp_path, license_, authors) | {"repository": None}, [])


def test_the_repository_stands_for_authors_that_are_not_named(tmp_path):
    made = crate(tmp_path, "Zlib OR MIT", ()) | {"repository": "https://example.org/made"}
    (text,) = notices.texts(made, [])
    assert "Copyright (c) the authors of https://example.org/made\n" in text


def test_wheel_without_license_stops(tmp_path):
    wheel = tmp_path / "other-2.0-py3-none-any.whl"
    with notices.zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr("other/__init__.py", "")
    with pytest.raises(SystemExit, match=r"other-2\.0"):
        notices.extension_notices([wheel])
