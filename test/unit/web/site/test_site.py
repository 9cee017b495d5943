"""Who is let in to the window."""

import http.client
import re
import socket
from contextlib import closing
from urllib.parse import urlsplit

import pytest
from support.browser import Browser
from support.patience import wait_until
from support.window import serving
from websockets.exceptions import InvalidStatus

from rosbots_description.web import Site, WindowError

TOKEN = 'a-token_of_16-chars'


@pytest.fixture
def open_site():
    """A window without a token."""
    with serving(is_open=True) as site:
        yield site


def get(address, **headers):
    """Return status, headers and text of an answer."""
    host = urlsplit(address).netloc
    with closing(http.client.HTTPConnection(host, timeout=60)) as connection:
        connection.request('GET', address.removeprefix(f'http://{host}'), headers=headers)
        answer = connection.getresponse()
        return answer.status, answer.headers, answer.read().decode()


def refusal(address, **headers):
    status, _, text = get(address, **headers)
    assert status == 403
    assert re.fullmatch(r'[^\n]+\.\n', text)  # a sentence
    return text


def entered(site):
    """Return the address inside, and the cookie that it came with."""
    status, headers, _ = get(site.address)
    assert status == 303
    return root(site) + headers['Location'].lstrip('/'), headers['Set-Cookie']


def root(site):
    return site.address.partition('?')[0]


def test_address_leads_to_the_page_and_sets_a_cookie_for_its_path_only(site, capfd):
    assert re.fullmatch(r'http://127\.0\.0\.1:\d+/\?token=[A-Za-z0-9_-]{43}', site.address)
    inside, cookie = entered(site)
    path = urlsplit(inside).path
    assert re.fullmatch(r'/[A-Za-z0-9_-]{22}/', path)
    name, *attributes = cookie.split('; ')
    assert name == f'rosbots_window_{site.get_port()}={site.token}'
    assert attributes == [f'Path={path.rstrip("/")}', 'HttpOnly', 'SameSite=Strict']
    status, _, text = get(inside)
    assert (status, '<html' in text) == (200, True)
    with Browser(inside.rstrip('/'), {'Cookie': name}) as browser:
        browser.wait_until(lambda: browser.messages)
    with Browser(site.address) as browser:
        browser.wait_until(lambda: browser.messages)
    assert capfd.readouterr().out == ''  # viser is not asked to tell


def test_other_parts_of_the_address_stay(site):
    _, headers, _ = get(f'{site.address}&darkMode&fixedDpr=1')
    assert headers['Location'].endswith('/?darkMode=&fixedDpr=1')


def test_two_windows_have_two_tokens_and_two_cookies(site):
    with serving() as other:
        assert other.token != site.token
        assert entered(other)[1].split('=')[0] != entered(site)[1].split('=')[0]
        assert 'token' in refusal(f'{root(site)}?token={other.token}')


def test_a_given_token_keeps_address_and_cookie_over_a_restart():
    addresses = set()
    for _ in range(2):
        with serving('127.0.0.1', TOKEN) as site:
            assert site.token == TOKEN
            addresses.add(urlsplit(entered(site)[0]).path)
    assert len(addresses) == 1


@pytest.mark.parametrize('token', ['short', 'x' * 129, 'with a space in it', 'semicolon;semicolon'])
def test_a_token_that_is_none_is_refused_in_a_sentence(token):
    with pytest.raises(WindowError, match='16 to 128 letters'):
        Site('127.0.0.1', 0, token)


def test_nothing_is_read_of_a_socket_without_the_token(site, monkeypatch):
    inside, _ = entered(site)
    for address in (root(site), f'{root(site)}?token=', inside, f'{inside}?token=x'):
        with pytest.raises(InvalidStatus, match='403'):
            Browser(address.rstrip('/') if '?' not in address else address)


def test_a_cookie_of_another_server_of_the_host_does_no_harm(site):
    inside, cookie = entered(site)
    name, _, value = cookie.split('; ')[0].partition('=')
    with Browser(inside, {'Cookie': f'{name}=evil; {name}={value}; {name}=; =;;'}) as browser:
        browser.wait_until(lambda: browser.messages)


def test_what_is_sent_to_a_browser_that_has_left_makes_no_noise(recwarn, site):
    with Browser(site.address) as browser:
        browser.wait_until(site.get_clients)
        (client,) = site.get_clients().values()
    wait_until(lambda: not site.get_clients())
    client.send_file_download('a', b'a')
    assert not [one for one in recwarn if 'closed connection' in str(one.message)]


@pytest.mark.parametrize('name', ['localhost', '127.0.0.1', 'behind.a.tunnel.example'])
def test_a_tunnel_to_this_machine_is_let_in(site, name):
    assert get(site.address, Host=f'{name}:9999')[0] == 303


def test_other_pages_in_the_same_browser_are_not(site):
    assert 'other pages' in refusal(site.address, Origin='http://evil.example')


def test_a_malformed_address_is_refused_in_a_sentence(site):
    assert 'malformed' in refusal(site.address, Origin='http://[')


def test_without_a_token_only_names_of_this_machine_lead_in(open_site):
    assert (open_site.token, open_site.address) == ('', f'http://127.0.0.1:{open_site.get_port()}/')
    status, _, text = get(open_site.address)
    assert (status, '<html' in text) == (200, True)
    for host in ('evil.example', 'evil.example:80', '192.0.2.1', ''):
        assert 'Without a token' in refusal(open_site.address, Host=host)
    with Browser(open_site.address) as browser:
        browser.wait_until(lambda: browser.messages)


def test_without_a_token_a_public_window_has_the_names_of_its_machine():
    with serving('0.0.0.0', is_open=True) as site:
        address = f'http://127.0.0.1:{site.get_port()}/'
        for host in ('192.0.2.1', socket.gethostname(), 'localhost'):
            assert get(address, Host=host)[0] == 200
        assert 'Without a token' in refusal(address, Host='evil.example')


def test_every_answer_forbids_frames_and_foreign_scripts(site):
    for address in (site.address, entered(site)[0], root(site), f'{root(site)}nothing'):
        _, headers, _ = get(address)
        policy = dict(part.split(' ', 1) for part in headers['Content-Security-Policy'].split('; '))
        assert policy['frame-ancestors'] == policy['default-src'] == "'none'"
        assert 'unsafe-inline' not in policy['script-src']
        assert 'http' not in headers['Content-Security-Policy']
        assert headers['X-Frame-Options'] == 'DENY'
        assert headers['X-Content-Type-Options'] == 'nosniff'
        assert headers['Referrer-Policy'] == 'no-referrer'
        assert 'Server' not in headers


def test_the_address_for_others_has_name_and_token():
    with serving('0.0.0.0', TOKEN) as site:
        assert site.address == f'http://{socket.gethostname()}:{site.get_port()}/?token={TOKEN}'


@pytest.mark.parametrize('path', ['../site.py', '%2e%2e/site.py', '..%5csite.py', 'etc/passwd'])
def test_a_path_that_climbs_leads_nowhere(site, path):
    assert get(entered(site)[0] + path)[0] == 404
    assert get(root(site) + path)[0] == 403


def test_the_page_is_not_published_through_other_servers(site):
    assert site.request_share_url() is None


def test_a_port_in_use_is_refused_in_a_sentence():
    with socket.create_server(('127.0.0.1', 0)) as taken:
        port = taken.getsockname()[1]
        sentence = rf'no window at 127\.0\.0\.1, port {port}: Address already in use; web_port'
        with pytest.raises(WindowError, match=sentence):
            Site('127.0.0.1', port)


@pytest.mark.parametrize(
    ('host', 'port'),
    [
        ('192.0.2.1', 0),
        ('no such host', 0),
        ('127.0.0.1', 99999),
        ('127.0.0.1', -1),
        ('a' * 70, 1),
    ],
)
def test_an_address_of_another_machine_is_refused_in_a_sentence(host, port):
    with pytest.raises(WindowError, match=r'^no window at .*, port -?\d+: .+; web_port and web_'):
        Site(host, port)
