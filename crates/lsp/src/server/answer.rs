//! Each request and its answer. Of what the protocol knows and this server does not, it is said.

use crate::tokens::legend;
use crate::uri::LIBRARY_SCHEME;
use crate::workspace::Workspace;
use lsp_server::{ErrorCode, Request, Response};
use lsp_types::{
    CodeActionKind, CodeActionOptions, CodeActionProvider, CodeActionRequest, CodeActionResponse,
    CodeLensOptions, CodeLensRequest, CompletionOptions, CompletionRequest, CompletionResponse,
    Definition, DefinitionRequest, DefinitionResponse, DocumentFormattingRequest,
    DocumentHighlightRequest, DocumentSymbolRequest, DocumentSymbolResponse, HoverRequest,
    InitializeResult, InlayHintRequest, LspRequestMethod, PrepareRenamePlaceholder,
    PrepareRenameRequest, PrepareRenameResult, ReferencesRequest, RenameOptions, RenameProvider,
    RenameRequest, Request as Asked, SemanticTokensOptions, SemanticTokensRequest,
    ServerCapabilities, ServerInfo, SignatureHelpOptions, SignatureHelpRequest,
    TextDocumentSyncKind, TextDocumentSyncOptions,
};
use obverse_compiler::library;
use serde_json::{Value, json};

/// The request for the text of a file of the library, which has no place on the disk: its
/// parameter `uri` is the address that a definition gives.
pub(crate) const LIBRARY_REQUEST: &str = "obverse/library";

/// What the server says of itself.
pub(super) fn initialized() -> InitializeResult {
    let sync = TextDocumentSyncOptions {
        open_close: Some(true),
        change: Some(TextDocumentSyncKind::Incremental),
        save: Some(true.into()),
        ..TextDocumentSyncOptions::default()
    };
    // Not a blank: a list that opens by itself would take the end of the line for a choice.
    let trigger = [".", ":"].map(str::to_owned).to_vec();
    // A blank is what the parts of a command begin with; where there is none, nothing opens.
    let signatures = SignatureHelpOptions {
        trigger_characters: Some(["(", ",", ":", " "].map(str::to_owned).to_vec()),
        ..SignatureHelpOptions::default()
    };
    let tokens =
        SemanticTokensOptions { legend: legend(), full: Some(true.into()), ..Default::default() };
    let rename = RenameOptions { prepare_provider: Some(true), ..RenameOptions::default() };
    let actions = CodeActionOptions {
        code_action_kinds: Some(vec![CodeActionKind::QuickFix]),
        ..CodeActionOptions::default()
    };
    let capabilities = ServerCapabilities {
        text_document_sync: Some(sync.into()),
        completion_provider: Some(CompletionOptions {
            trigger_characters: Some(trigger),
            ..CompletionOptions::default()
        }),
        signature_help_provider: Some(signatures),
        hover_provider: Some(true.into()),
        definition_provider: Some(true.into()),
        references_provider: Some(true.into()),
        document_highlight_provider: Some(true.into()),
        document_symbol_provider: Some(true.into()),
        code_action_provider: Some(CodeActionProvider::CodeActionOptions(actions)),
        code_lens_provider: Some(CodeLensOptions::default()),
        document_formatting_provider: Some(true.into()),
        rename_provider: Some(RenameProvider::RenameOptions(rename)),
        semantic_tokens_provider: Some(tokens.into()),
        inlay_hint_provider: Some(true.into()),
        ..ServerCapabilities::default()
    };
    let version = Some(env!("CARGO_PKG_VERSION").to_owned());
    InitializeResult::new(capabilities, Some(ServerInfo { name: "obverse".to_owned(), version }))
}

/// Whether an editor says when it is initialized that it can be asked to tell of files.
pub(super) fn can_watch(params: &Value) -> bool {
    let of_workspace = &params["capabilities"]["workspace"];
    of_workspace["didChangeWatchedFiles"]["dynamicRegistration"] == true
}

/// Whether an editor says when it is initialized that it can be told of no parameter at hand.
pub(super) fn can_have_none_active(params: &Value) -> bool {
    let of_help = &params["capabilities"]["textDocument"]["signatureHelp"];
    let of_signature = &of_help["signatureInformation"];
    [of_help, of_signature].iter().any(|known| known["noActiveParameterSupport"] == true)
}

/// The request to be told of files that change on the disk.
pub(super) fn watching() -> Request {
    let watchers = json!([{ "globPattern": "**/*.{obv,toml}" }]);
    let registration = json!({
        "id": "files",
        "method": "workspace/didChangeWatchedFiles",
        "registerOptions": { "watchers": watchers },
    });
    let params = json!({ "registrations": [registration] });
    Request::new(1.into(), "client/registerCapability".to_owned(), params)
}

/// The answer to a request.
pub(super) fn answer(workspace: &mut Workspace, request: Request) -> Response {
    use LspRequestMethod as Method;
    if request.method == LIBRARY_REQUEST {
        return library_text(request);
    }
    let method = request.method.clone();
    match Method::from(method.as_str()) {
        Method::TextDocumentHover => reply::<HoverRequest>(request, |params| {
            let at = params.text_document_position_params;
            Ok(workspace.hover(&at.text_document.uri, at.position))
        }),
        Method::TextDocumentDefinition => reply::<DefinitionRequest>(request, |params| {
            let at = params.text_document_position_params;
            let found = workspace.definition(&at.text_document.uri, at.position);
            Ok(Some(DefinitionResponse::Definition(Definition::LocationList(found))))
        }),
        Method::TextDocumentReferences => reply::<ReferencesRequest>(request, |params| {
            let at = params.text_document_position_params;
            let with_declarations = params.context.include_declaration;
            let uri = at.text_document.uri;
            Ok(Some(workspace.references(&uri, at.position, with_declarations)))
        }),
        Method::TextDocumentDocumentHighlight => {
            reply::<DocumentHighlightRequest>(request, |params| {
                let at = params.text_document_position_params;
                Ok(Some(workspace.highlights(&at.text_document.uri, at.position)))
            })
        }
        Method::TextDocumentPrepareRename => reply::<PrepareRenameRequest>(request, |params| {
            let at = params.text_document_position_params;
            let found = workspace.prepare_rename(&at.text_document.uri, at.position)?;
            Ok(found.map(|(range, placeholder)| {
                PrepareRenameResult::from(PrepareRenamePlaceholder { range, placeholder })
            }))
        }),
        Method::TextDocumentRename => reply::<RenameRequest>(request, |params| {
            let at = params.text_document_position_params;
            workspace.rename(&at.text_document.uri, at.position, &params.new_name).map(Some)
        }),
        Method::TextDocumentCompletion => reply::<CompletionRequest>(request, |params| {
            let at = params.text_document_position_params;
            let found = workspace.completion(&at.text_document.uri, at.position);
            Ok(Some(CompletionResponse::CompletionList(found)))
        }),
        Method::TextDocumentSignatureHelp => reply::<SignatureHelpRequest>(request, |params| {
            let at = params.text_document_position_params;
            Ok(workspace.signature(&at.text_document.uri, at.position))
        }),
        _ => of_document(workspace, request, &method),
    }
}

/// The answer to a request that is of a whole text, or of a range of it.
fn of_document(workspace: &mut Workspace, request: Request, method: &str) -> Response {
    use LspRequestMethod as Method;
    match Method::from(method) {
        Method::TextDocumentDocumentSymbol => reply::<DocumentSymbolRequest>(request, |params| {
            let found = workspace.outline(&params.text_document.uri);
            Ok(Some(DocumentSymbolResponse::DocumentSymbolList(found)))
        }),
        Method::TextDocumentSemanticTokensFull => {
            reply::<SemanticTokensRequest>(request, |params| {
                Ok(workspace.tokens(&params.text_document.uri))
            })
        }
        Method::TextDocumentFormatting => reply::<DocumentFormattingRequest>(request, |params| {
            Ok(workspace.formatting(&params.text_document.uri))
        }),
        Method::TextDocumentCodeAction => reply::<CodeActionRequest>(request, |params| {
            let found = workspace.code_actions(&params.text_document.uri, params.range);
            Ok(Some(found.into_iter().map(CodeActionResponse::CodeAction).collect()))
        }),
        Method::TextDocumentInlayHint => reply::<InlayHintRequest>(request, |params| {
            Ok(Some(workspace.hints(&params.text_document.uri, params.range)))
        }),
        Method::TextDocumentCodeLens => reply::<CodeLensRequest>(request, |params| {
            Ok(Some(workspace.lenses(&params.text_document.uri)))
        }),
        _ => {
            let why = format!("there is no request `{method}` here");
            Response::new_err(request.id, ErrorCode::MethodNotFound as i32, why)
        }
    }
}

/// What a request is answered with, if its parameters can be read.
fn reply<R: Asked>(
    request: Request,
    answer: impl FnOnce(R::Params) -> Result<R::Result, String>,
) -> Response
where
    R::Params: serde::de::DeserializeOwned,
    R::Result: serde::Serialize,
{
    let Request { id, params, .. } = request;
    let params = match serde_json::from_value(params) {
        Ok(params) => params,
        Err(error) => {
            let code = ErrorCode::InvalidParams as i32;
            return Response::new_err(id, code, format!("wrong parameters: {error}"));
        }
    };
    match answer(params) {
        Ok(result) => Response::new_ok(id, result),
        Err(why) => Response::new_err(id, ErrorCode::RequestFailed as i32, why),
    }
}

/// The text of a file of the library.
fn library_text(request: Request) -> Response {
    let uri = request.params.get("uri").and_then(Value::as_str).unwrap_or_default();
    let name = uri.strip_prefix(LIBRARY_SCHEME).unwrap_or(uri).trim_end_matches(".obv");
    match library::FILES.iter().find(|(known, _)| *known == name) {
        Some((_, text)) => Response::new_ok(request.id, text()),
        None => {
            let why = format!("the library has no file `{uri}`");
            Response::new_err(request.id, ErrorCode::InvalidParams as i32, why)
        }
    }
}
